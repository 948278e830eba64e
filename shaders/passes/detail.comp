#version 450 core
// A tile of ground finer than the source, from its parent's slot into its own; an invocation a sample.
#include "../lib/detail_texels.h"
#include "../shared/detail_octave.h"
#include "../shared/disc_uniforms.h"

layout(local_size_x = kDetailGroup) in;

layout(binding = kHeightTilesUnit) uniform isampler2DArray height_tiles;
layout(binding = kMadeTilesImage, r32i) writeonly uniform iimage2DArray made_tiles;

layout(location = 0) uniform ivec4 corner_and_first;  // in the parent: the child's corner; of the parent: its first sample
layout(location = 1) uniform ivec4 slots_side_octave;  // the parent's, the child's; samples of a tile's side
layout(location = 2) uniform ivec4 gains;
layout(location = 3) uniform ivec2 shift_and_source;  // the second: 1 where the parent is one of the source's

int parent_texel(ivec2 at) { return texelFetch(height_tiles, ivec3(at + kHeightApron, slots_side_octave.x), 0).x; }
int detail_height(ivec2 at) {
    int texel = parent_texel(at);
    return shift_and_source.y == 1 ? finer_height(texel, shift_and_source.x) : texel >> 1;
}
#include "../lib/detail.h"

void main() {
    int i = int(gl_GlobalInvocationID.x), side = slots_side_octave.z;
    if (i >= side * side) return;
    ivec2 place = ivec2(i % side, i / side);
    ivec2 child = corner_and_first.xy + place - kHeightApron;
    int height = detail_sample(child, corner_and_first.zw, slots_side_octave.w, DetailOctave(gains.x, gains.y, gains.z, gains.w));
    bool terrain = (parent_texel(child >> 1) & 1) != 0;
    imageStore(made_tiles, ivec3(place, slots_side_octave.y), ivec4(made_texel(height, terrain)));
}
