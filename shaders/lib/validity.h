// Which cells of a node are terrain: one bit a cell, row by row, 32 to a word, least significant first; and
// the raster's far borders, which cut the last column and row of nodes.
#pragma once

#include "../shared/portable.h"
#include "../shared/terrain_instance.h"

SHADER_BEGIN

// `texel`: cells from the node's corner (columns, rows), in [0, quads]. The far border belongs to the last
// cell.
SHADER_FUNCTION int cell_at(vec2 texel, int quads) {
    int column = clamp(int(floor(texel.x)), 0, quads - 1);
    int row = clamp(int(floor(texel.y)), 0, quads - 1);
    return row * quads + column;
}

SHADER_FUNCTION bool cell_bit(uint word, int cell) { return ((word >> uint(cell & 31)) & 1u) != 0u; }

SHADER_FUNCTION bool inside_raster(vec2 texel, vec2 last) { return texel.x <= last.x && texel.y <= last.y; }

// For the programs of nodes that are cut.
#if !defined(__cplusplus) && defined(RIDGELINE_CUT)
layout(std430, binding = kChunkWordsBinding) readonly buffer ChunkWords { uint chunk_words[]; };

bool terrain_at(vec2 texel, uint mask_word, vec2 last, int quads) {
    int cell = cell_at(texel, quads);
    bool valid = mask_word == kNoMask || cell_bit(chunk_words[mask_word + uint(cell >> 5)], cell);
    return valid && inside_raster(texel, last);
}
#endif

SHADER_END
