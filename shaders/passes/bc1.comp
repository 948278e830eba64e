#version 450 core
// Texels into BC1 blocks, one invocation a block.
#include "../lib/bc1.h"

layout(local_size_x = kBc1Group) in;

layout(location = 0) uniform int first;
layout(location = 1) uniform int count;
layout(std430, binding = kBc1TexelsBinding) readonly buffer TexelsBlock { Bc1Texels texels[]; };
layout(std430, binding = kBc1BlocksBinding) writeonly buffer BlocksBlock { uvec2 blocks[]; };

void main() {
    int i = int(gl_GlobalInvocationID.x);
    if (i < count) blocks[first + i] = bc1_encoded(texels[first + i]);
}
