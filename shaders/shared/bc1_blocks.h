// Blocks of 4 × 4 texels on their way to the GPU, and what comes back: BC1, two words a block.
// terrain/render/block_encoder.cpp sends and fetches them.
#pragma once

#include "portable.h"

SHADER_BEGIN

SHADER_CONSTANT int kBc1TexelsBinding = 0;
SHADER_CONSTANT int kBc1BlocksBinding = 1;

// Blocks of a work group.
SHADER_CONSTANT int kBc1Group = 64;

// Row by row from the north-western texel; a texel is its bytes red, green, blue, alpha, red the lowest.
struct Bc1Texels {
    uvec4 rows[4];
};

SHADER_STRUCT_SIZE(Bc1Texels, 64)

SHADER_END
