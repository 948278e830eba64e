// Normals of the full-resolution surface, kept as (east, north) pairs in squares of a texture array: they
// light a simplified chunk as the surface that it stands for (horizon paper §2).
//
// A node's shading moves from its own normals to its parent's with the morph weight, so that it is the same
// on both sides of a border between levels.
#pragma once

#include "../shared/portable.h"
#include "../shared/terrain_instance.h"

SHADER_BEGIN

// The four texels about a place, and how far it lies between them. Filtered by hand: a sampler's coordinates
// would be rounded by where in the array the square happens to lie, and pictures must not depend on that.
struct NormalTexels {
    ivec3 north_west;  // column, row, layer
    vec2 share;        // of the eastern and of the southern ones
};

// (quads + 1)^2 texels a square: texel i stands over lattice line i. `texel` in [0, quads].
SHADER_FUNCTION NormalTexels normal_texels(uint place, vec2 texel, int quads) {
    int column = clamp(int(floor(texel.x)), 0, quads - 1);
    int row = clamp(int(floor(texel.y)), 0, quads - 1);
    int side = quads + 1;
    NormalTexels texels;
    texels.north_west =
        ivec3(int(place & 0xffu) * side + column, int((place >> 8u) & 0xffu) * side + row, int(place >> 16u));
    texels.share = vec2(texel.x - float(column), texel.y - float(row));
    return texels;
}

// The same place counted in the parent's texels.
SHADER_FUNCTION vec2 parent_texel(vec2 texel, uint quarter, int quads) {
    vec2 corner = vec2(float(quarter & 1u), float((quarter >> 1u) & 1u)) * (0.5f * float(quads));
    return corner + texel * 0.5f;
}

// Filtered pairs are shorter than unit length asks for; what lacks is the height.
SHADER_FUNCTION vec3 unpack_normal(vec2 east_north) {
    float horizontal = min(dot(east_north, east_north), 1.0f);
    return vec3(east_north.x, east_north.y, sqrt(1.0f - horizontal));
}

// The normal of the surface stretched upwards by 1 / inverse_exaggeration.
SHADER_FUNCTION vec3 exaggerate_normal(vec3 normal, float inverse_exaggeration) {
    return normalize(vec3(normal.x, normal.y, normal.z * inverse_exaggeration));
}

SHADER_END
