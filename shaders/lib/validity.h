// Which cells of a node are terrain: one bit a cell, row by row, 32 to a word, least significant first; and
// the raster's far borders, which cut the last column and row of nodes.
#pragma once

#include "../shared/portable.h"

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

SHADER_END
