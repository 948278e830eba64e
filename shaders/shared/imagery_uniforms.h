// The uniform block of the imagery's virtual texture, and what its page table holds. Written once a frame by
// terrain/render/imagery_texture.cpp; docs/imagery.md explains it.
#pragma once

#include "portable.h"

SHADER_BEGIN

SHADER_CONSTANT int kImageryUniformsBinding = 2;
SHADER_CONSTANT int kImageryFadesBinding = 3;
SHADER_CONSTANT int kPageTableUnit = 3;
SHADER_CONSTANT int kImageryUnit = 4;

// As io/imagery_tile.h has them: texels of a tile's content, log2 of them, the gutter, the whole side.
SHADER_CONSTANT int kTileTexelBits = 8;
SHADER_CONSTANT float kTileGutter = 4.0f;
SHADER_CONSTANT float kTileSide = 264.0f;

// An entry of the page table: the slot and one more, 0 where there is nothing; then how many levels the tile
// in the slot lies above the finest.
SHADER_CONSTANT uint kPageSlotMask = 0xffffu;
SHADER_CONSTANT int kPageCoarsenessShift = 16;

struct ImageryUniforms {
    // The eye's place on the imagery: what it is past its cell, in finest texels, east and south; then finest
    // texels to a metre, east and south.
    vec4 eye_rest_and_scale;
    // The eye's cell (column, row of a finest texel, kept on the lattice), then the lattice's columns and
    // rows.
    ivec4 eye_cell_and_size;
    // Level of the finest texels; log2 of the columns and of the rows of a page table's level; w unused.
    ivec4 table;
    // How many times longer than wide a pixel's print may be before it blurs; how many lookups the shader may
    // lay along it, 1 where the sampler does that; finest texels, to a metre of distance, that a pixel's
    // print is taken for at most; w unused.
    vec4 filtering;
};

SHADER_STRUCT_SIZE(ImageryUniforms, 64)
SHADER_OFFSET(ImageryUniforms, eye_cell_and_size, 16)
SHADER_OFFSET(ImageryUniforms, filtering, 48)

SHADER_END
