#version 450 core
// The ground's colour. RIDGELINE_CUT: for nodes with holes or past the raster's border, where fragments are
// dropped. RIDGELINE_SHADOWS: with the shadows that the ground casts on itself. RIDGELINE_IMAGERY: in the
// imagery's colours, where it has any; RIDGELINE_IMAGERY_WHOLE besides: it has them wherever there is ground,
// and no tint is made. RIDGELINE_DISC: of the disc, whose normals and holes come from cached heights.
// RIDGELINE_CULL_FRAGMENTS: back faces are dropped here, not before.
#include "../lib/display.h"
#include "../lib/shadow.h"
#include "../lib/terrain_shading.h"
#include "../lib/validity.h"
#include "../lib/virtual_texture.h"
#include "../shared/shadow_uniforms.h"

#ifdef RIDGELINE_DISC
#include "../shared/disc_uniforms.h"
layout(std140, binding = kDiscUniformsBinding) uniform DiscBlock { DiscUniforms disc; };
layout(std430, binding = kHeightFadesBinding) readonly buffer HeightFades { float height_fades[]; };
layout(binding = kHeightTableUnit) uniform usampler2DArray height_table;
layout(binding = kHeightTilesUnit) uniform isampler2DArray height_tiles;
#include "../lib/disc.h"
#else
layout(location = 0) in vec3 texel_and_weight;
layout(location = 1) flat in uvec4 node_sources;
#ifdef RIDGELINE_CUT
layout(location = 2) flat in vec2 node_last;
#endif

layout(binding = kNormalsUnit) uniform sampler2DArray normals;
layout(location = 0) uniform int quads;
#endif

layout(binding = kNoiseUnit) uniform sampler2D noise;
#ifdef RIDGELINE_SHADOWS
layout(binding = kShadowMapUnit) uniform sampler2DArrayShadow shadow_maps;
#endif

#ifdef RIDGELINE_IMAGERY
layout(std140, binding = kImageryUniformsBinding) uniform ImageryBlock { ImageryUniforms imagery; };
layout(std430, binding = kImageryFadesBinding) readonly buffer ImageryFades { float imagery_fades[]; };
layout(binding = kPageTableUnit) uniform usampler2DArray page_table;
layout(binding = kImageryUnit) uniform sampler2DArray imagery_tiles;
#endif

layout(location = 0) out vec4 color;

vec3 ground_position() {
    vec3 ray = frame.ray_origin.xyz + gl_FragCoord.x * frame.ray_dx.xyz + gl_FragCoord.y * frame.ray_dy.xyz;
    return ray / gl_FragCoord.w;
}

#ifdef RIDGELINE_DISC
// False where no terrain is. Else slopes and height there, blended from level to level.
bool disc_ground(vec3 position, out vec3 ground) {
    ground = vec3(0.0);
    LatticePlace place = lattice_place(disc, position.xy, frame.scale.xy);
    if (!inside_lattice(disc, place)) return false;
    float coarseness = shading_coarseness(disc, length(position));
    HeightPage own = height_page(disc, place.cell, int(coarseness));
    if (own.page == 0u || !terrain_in(disc, own)) return false;
    ground = slopes_and_height_in(disc, place, own, frame.eye_cell.x);
    int found = page_coarseness(own.page);
    float share = max(coarseness - float(found), height_fades[page_slot(own.page)]);
    if (share <= 0.0 || found >= disc.table.x) return true;
    HeightPage next = height_page(disc, place.cell, found + 1);
    ground = mix(ground, slopes_and_height_in(disc, place, next, frame.eye_cell.x), min(share, 1.0));
    return true;
}

// True, without exaggeration.
vec3 disc_normal(vec2 slopes) {
    float quantum_m = frame.scale.z * frame.scale.w;
    return normalize(vec3(-slopes.x * quantum_m / frame.scale.x, slopes.y * quantum_m / frame.scale.y, 1.0));
}
#else
vec2 normal_pair(uint place, vec2 texel) {
    NormalTexels at = normal_texels(place, texel, quads);
    vec2 north_west = texelFetch(normals, at.north_west, 0).xy;
    vec2 north_east = texelFetch(normals, at.north_west + ivec3(1, 0, 0), 0).xy;
    vec2 south_west = texelFetch(normals, at.north_west + ivec3(0, 1, 0), 0).xy;
    vec2 south_east = texelFetch(normals, at.north_west + ivec3(1, 1, 0), 0).xy;
    return mix(mix(north_west, north_east, at.share.x), mix(south_west, south_east, at.share.x), at.share.y);
}

vec3 node_normal() {
    vec2 own = normal_pair(node_sources.x, texel_and_weight.xy);
    vec2 parent = normal_pair(node_sources.y, parent_texel(texel_and_weight.xy, node_sources.w, quads));
    return unpack_normal(mix(own, parent, texel_and_weight.z));
}
#endif

#ifdef RIDGELINE_SHADOWS
// The triangle's own normal, towards the eye: what its neighbours in the picture lie on.
vec3 facet_normal(vec3 position) {
    vec3 across = cross(dFdx(position), dFdy(position));
    float size = length(across);
    vec3 normal = size > 0.0 ? across / size : vec3(0.0, 0.0, 1.0);
    return dot(normal, position) > 0.0 ? -normal : normal;
}

float sunlit_in(int cascade, vec3 position, vec3 facet) {
    vec2 texel_m = shadows.cascades[cascade].reach_and_texel.zw;
    vec2 tilt = vec2(dot(facet, shadows.across.xyz), dot(facet, shadows.along.xyz));
    vec3 place = position + facet * normal_offset_m(tilt, texel_m);
    vec3 map = (shadows.cascades[cascade].map_from_eye * vec4(place, 1.0)).xyz;
    ShadowTaps taps = shadow_taps((0.5 + 0.5 * map.xy) * shadows.map.x);
    vec4 at = vec4(taps.x, taps.y) * shadows.map.y;
    float layer = float(cascade), depth = map.z + shadows.map.z;
    vec4 lit = vec4(texture(shadow_maps, vec4(at.x, at.z, layer, depth)), texture(shadow_maps, vec4(at.y, at.z, layer, depth)),
                    texture(shadow_maps, vec4(at.x, at.w, layer, depth)), texture(shadow_maps, vec4(at.y, at.w, layer, depth)));
    return sunlit_share(lit, taps);
}

float sunlit(vec3 position, vec3 facet) {
    float distance_m = length(position);
    int cascade = 0;
    while (cascade < kShadowCascades - 1 && distance_m >= shadows.cascades[cascade].reach_and_texel.y) ++cascade;
    float lit = sunlit_in(cascade, position, facet);
    float next = next_cascade_share(shadows.cascades[cascade].reach_and_texel, distance_m);
    if (next > 0.0 && cascade < kShadowCascades - 1) lit = blended_light(lit, sunlit_in(cascade + 1, position, facet), next);
    return lit;
}
#endif

#ifdef RIDGELINE_IMAGERY
// Linear colour times coverage, coverage. coarseness: the binary logarithm of its finest texels a pixel.
vec4 picture_at(vec3 position, out float coarseness) {
    vec2 texels_per_metre = vec2(imagery.eye_rest_and_scale.z, -imagery.eye_rest_and_scale.w);
    vec2 dx = dFdx(position.xy) * texels_per_metre, dy = dFdy(position.xy) * texels_per_metre;
    ImageryPlace place = imagery_place(imagery, position.xy);
    coarseness = 0.0;
    if (!on_imagery(imagery, place.cell)) return vec4(0.0);
    float most = log2(length(position) * imagery.filtering.z);
    coarseness = min(wanted_coarseness(dx, dy, imagery.filtering.x), most);
    float share = print_share(dx, dy, coarseness, imagery.filtering.x);
    dx *= share;
    dy *= share;
    uint page = texelFetch(page_table, page_address(imagery, place.cell, coarseness), 0).x;
    if (page == 0u) return vec4(0.0);
    ImageryTap tap = imagery_tap(place, page, coarseness, imagery_fades[page_slot(page)]);
    if (imagery.filtering.y < 1.5)
        return textureGrad(imagery_tiles, vec3(tap.at, tap.layer), dx * tap.gradient, dy * tap.gradient);
    ImageryPrint print = imagery_print(dx, dy, imagery.filtering.xy);
    vec2 width = vec2(print.width * tap.gradient, 0.0), way = print.step * tap.gradient;
    vec2 at = tap.at - way * (0.5 * float(print.taps - 1));
    vec4 sum = vec4(0.0);
    for (int i = 0; i < print.taps; ++i, at += way) sum += textureGrad(imagery_tiles, vec3(at, tap.layer), width.xy, width.yx);
    return sum / float(print.taps);
}
#endif

#ifdef RIDGELINE_IMAGERY_WHOLE
// No sampler is asked where the picture has structure enough.
vec3 noise_at(vec2 repeats, vec2 dx, vec2 dy, float structure) {
    return structure > 0.0 ? textureGrad(noise, repeats, 0.5 * dx, 0.5 * dy).xyz : vec3(0.0);
}
#endif

// structure: how much of the ground's noise will show, where a picture covers it.
GroundPoint ground_point(vec3 position, vec3 normal, float height_m, float lit, float structure) {
#ifdef RIDGELINE_IMAGERY_WHOLE
    vec2 dx = dFdx(position.xy), dy = dFdy(position.xy);
    vec2 scale = frame.noise_scale.xy;
    vec3 fine = noise_at(position.xy * scale.x + frame.noise_offset.xy, dx * scale.x, dy * scale.x, structure);
    vec3 broad = noise_at(position.xy * scale.y + frame.noise_offset.zw, dx * scale.y, dy * scale.y, structure);
#else
    // One mip level finer than the pixel: ground seen at a glancing angle would be a blur otherwise.
    vec3 fine = texture(noise, position.xy * frame.noise_scale.x + frame.noise_offset.xy, -1.0).xyz;
    vec3 broad = texture(noise, position.xy * frame.noise_scale.y + frame.noise_offset.zw, -1.0).xyz;
#endif
    return GroundPoint(position, normal, height_m, lit, fine, broad);
}

#ifdef RIDGELINE_SHADOWS
// Chunks of the source cast the shadows: what is made below them must not lie in their own.
vec3 shadowed_position(vec3 position) {
#ifdef RIDGELINE_DISC
    if (disc.detail.x == 0) return position;
    LatticePlace place = lattice_place(disc, position.xy, frame.scale.xy);
    HeightPage source = height_page(disc, place.cell, disc.detail.x);
    if (source.page == 0u) return position;
    float height = slopes_and_height_in(disc, place, source, frame.eye_cell.x).z;
    position.z = max(position.z, (height - frame.eye_rest.z) * frame.scale.z);
#endif
    return position;
}
#endif

void main() {
#ifdef RIDGELINE_CULL_FRAGMENTS
    if (!gl_FrontFacing) discard;
#endif
    vec3 position = ground_position();
#ifdef RIDGELINE_SHADOWS
    float lit = sunlit(shadowed_position(position), facet_normal(position));
#else
    float lit = 1.0;
#endif
#ifdef RIDGELINE_DISC
    vec3 ground;
    if (!disc_ground(position, ground)) discard;
    vec3 normal = disc_normal(ground.xy);
    float height_m = true_height_m(frame, (ground.z - frame.eye_rest.z) * frame.scale.z);
#else
    float height_m = true_height_m(frame, position.z);
    vec3 normal = node_normal();
#endif
#ifdef RIDGELINE_CUT
    if (!terrain_at(texel_and_weight.xy, node_sources.z, node_last, quads)) discard;
#endif
#ifdef RIDGELINE_IMAGERY
    float coarseness;
    vec4 picture = picture_at(position, coarseness);
    float structure = lacking_structure(frame, coarseness);
    GroundPoint point = ground_point(position, normal, height_m, lit, structure);
#ifdef RIDGELINE_IMAGERY_WHOLE
    vec3 radiance = wholly_pictured_radiance(frame, point, picture, structure);
#else
    vec3 radiance = pictured_radiance(frame, point, picture, structure);
#endif
#else
    vec3 radiance = ground_radiance(frame, ground_point(position, normal, height_m, lit, 1.0));
#endif
    color = display_color(radiance, gl_FragCoord.xy, frame.background);
}
