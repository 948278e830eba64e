// How a block's entries, and the cells of a tile's shape, are numbered.
#pragma once

#include "../shared/quadtree_blocks.h"

SHADER_BEGIN

SHADER_FUNCTION ivec2 entry_place(int entry) {
    return ivec2(entry & (kQuadtreeSide - 1), entry >> kQuadtreeDepth);
}
SHADER_FUNCTION int entry_at(ivec2 place) { return place.y * kQuadtreeSide + place.x; }

// The first cell of a depth in a shape's errors.
SHADER_FUNCTION int shape_first(int depth) { return depth == 0 ? 0 : depth == 1 ? 1 : 5; }
SHADER_FUNCTION int shape_index(ivec2 place, int depth) {
    int shift = kQuadtreeDepth - depth;
    return shape_first(depth) + ((place.y >> shift) << depth) + (place.x >> shift);
}

SHADER_END
