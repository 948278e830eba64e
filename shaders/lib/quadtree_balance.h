// How the quadtree's neighbours are brought within a level of each other (gpu-quadtree paper, 3.3), in passes over
// all entries until one changes nothing. Levels only sink, so it does not matter who comes first.
#pragma once

#include "quadtree.h"

// What lowers an entry's level, and tells whether it was higher: in GLSL a function of that name, in C++ one of
// the object.
#ifdef __cplusplus
#define QUADTREE_LOWER(i, level) quadtree.lower(i, level)
#define QUADTREE_LOWERED_PARAMETER Quadtree &quadtree,
#else
#define QUADTREE_LOWER(i, level) lower_level(i, level)
#define QUADTREE_LOWERED_PARAMETER
#endif

SHADER_BEGIN

// The level of the cell that holds an entry, where no entry may be coarser than its own number says: the
// coarsest cell about it all of whose entries allow it.
QUADTREE_FUNCTION int leaf_level(QUADTREE_PARAMETER int block, ivec2 place) {
    QuadtreeBlock held = QUADTREE_BLOCK(block);
    for (int depth = least_depth(held); depth < kQuadtreeDepth; ++depth) {
        int shift = kQuadtreeDepth - depth, level = held.coarseness + shift;
        int side = 1 << shift;
        ivec2 first = ivec2((place.x >> shift) << shift, (place.y >> shift) << shift);
        bool allowed = true;
        for (int i = 0; i < side * side && allowed; ++i) {
            ivec2 at = ivec2(first.x + (i & (side - 1)), first.y + (i >> shift));
            allowed = QUADTREE_LEVEL(block * kQuadtreeEntries + entry_at(at)) >= level;
        }
        if (allowed) return level;
    }
    return held.coarseness;
}

// An entry's neighbours are no more than a level coarser. What an entry asks of one at a sample beside it:
// which entry, as a place in the levels, and the level that it may have at most; entry -1 where it asks
// nothing. Neighbours in finer blocks ask by themselves, and give what is asked of them in `own`.
struct QuadtreeAsk {
    int entry;
    int most;
    int own;
};

QUADTREE_FUNCTION QuadtreeAsk ask_neighbour(QUADTREE_PARAMETER QuadtreeUniforms view, int block, ivec2 place,
                                            int level, ivec2 way) {
    QuadtreeAsk ask;
    ask.entry = -1;
    ask.most = level + 1;
    ask.own = level;
    QuadtreeBlock held = QUADTREE_BLOCK(block);
    int shift = cell_shift(view, held.coarseness);
    ivec2 corner = block_corner(view, held);
    ivec2 beside = ivec2(corner.x + ((place.x + way.x) << shift), corner.y + ((place.y + way.y) << shift));
    // Of a larger neighbour the sample that touches the entry.
    beside = ivec2(way.x < 0 ? corner.x + (place.x << shift) - 1 : beside.x,
                   way.y < 0 ? corner.y + (place.y << shift) - 1 : beside.y);
    QuadtreeEntry found = entry_beside(QUADTREE view, beside, held.coarseness);
    if (found.block < 0) return ask;
    QuadtreeBlock other = QUADTREE_BLOCK(found.block);
    if (other.coarseness < held.coarseness) return ask;
    int at = found.block * kQuadtreeEntries + entry_at(found.place);
    // No finer than its block.
    ask.most = max(ask.most, other.coarseness);
    if (QUADTREE_LEVEL(at) > ask.most) ask.entry = at;
    ask.own = max(min(level, QUADTREE_LEVEL(at) + 1), held.coarseness);
    return ask;
}

// An entry that its block draws asks those about it, and takes what they ask of it. Whether that changed anything.
QUADTREE_FUNCTION bool balance_entry(QUADTREE_LOWERED_PARAMETER QuadtreeUniforms view, int block,
                                     ivec2 place) {
    if (!has_entry(QUADTREE_BLOCK(block), place)) return false;
    int level = leaf_level(QUADTREE block, place);
    bool changed = false;
    for (int way = 0; way < 9; ++way) {
        if (way == 4) continue;
        QuadtreeAsk asked =
            ask_neighbour(QUADTREE view, block, place, level, ivec2(way % 3 - 1, way / 3 - 1));
        level = min(level, asked.own);
        if (asked.entry >= 0) changed = QUADTREE_LOWER(asked.entry, asked.most) || changed;
    }
    return QUADTREE_LOWER(block * kQuadtreeEntries + entry_at(place), level) || changed;
}

SHADER_END
