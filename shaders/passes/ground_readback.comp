#version 450 core
// Which ground the picture shows: from its depth to places, from these to their reach and to cells of a mask.
#include "../lib/ground_cells.h"
#include "../shared/frame_uniforms.h"
#include "../shared/ground_readback.h"

layout(local_size_x = kGroundGroup, local_size_y = kGroundGroup) in;

layout(location = 0) uniform vec2 corner_m;
layout(location = 1) uniform float cells_per_m;
layout(location = 2) uniform ivec2 centre;
layout(location = 3) uniform ivec2 count;
layout(location = 4) uniform float near_m;
layout(location = 5) uniform ivec2 step_px;
layout(binding = kGroundDepthUnit) uniform sampler2D depth;
layout(std430, binding = kGroundResultBinding) buffer ResultBlock { GroundResult result; };

// Of the work group, so that the whole picture does not meet at four numbers.
shared uint group_reach[4];

// Metres from the eye: depth is near over the distance ahead, and the rays are of unit depth.
vec2 place_of(vec2 window, float at_depth) {
    vec2 ray = frame.ray_origin.xy + window.x * frame.ray_dx.xy + window.y * frame.ray_dy.xy;
    return ray * (near_m / at_depth);
}

// Most samples reach no farther than others did, and find their cell taken: a look is cheaper than an atomic.
void add_reach(int side, float reach_m) {
    uint bits = ordered_bits(reach_m);
    if (bits > group_reach[side]) atomicMax(group_reach[side], bits);
}

void add_cell(vec2 place) {
    ivec2 cell = ground_cell(place, GroundCells(corner_m, cells_per_m, centre, count));
    int grid = innermost_grid(cell, centre);
    ivec2 at = cell_in_grid(cell, centre, grid);
    int word = ground_word(at, grid);
    uint bit = ground_bit(at);
    if ((result.cells[word] & bit) == 0u) atomicOr(result.cells[word], bit);
}

void main() {
    if (gl_LocalInvocationIndex < 4u) group_reach[gl_LocalInvocationIndex] = 0u;
    barrier();
    ivec2 size = textureSize(depth, 0);
    // The last column and row count, wherever the steps end.
    ivec2 texel = min(ivec2(gl_GlobalInvocationID.xy) * step_px, size - 1);
    float at_depth = texelFetch(depth, texel, 0).r;
    if (at_depth > 0.0) {
        vec2 place = place_of(vec2(texel) + 0.5, at_depth);
        add_reach(0, -place.x);
        add_reach(1, -place.y);
        add_reach(2, place.x);
        add_reach(3, place.y);
        add_cell(place);
    }
    barrier();
    if (gl_LocalInvocationIndex < 4u)
        atomicMax(result.reach[gl_LocalInvocationIndex], group_reach[gl_LocalInvocationIndex]);
}
