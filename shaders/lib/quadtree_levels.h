// The level that a cell asks for, and how far it has turned into its parent: by how near the eye is, and how wrong
// the cell is drawn.
//
// Both are one number, the lod: kLodSteps a level. A tile that has just come looks like the one above it, and turns into its
// own look (disc.h, ring_height). What its entries ask for turns along, from the lods that the block above would draw its
// own ground with to those that the tile asks for by itself: so a tile that comes changes nothing, and however much it knows
// that those above did not, no level passes faster than the tile turns. A block without a tile of its own is as the one
// above it throughout.
//
// A block's lods are worked out together, after those of the block above while it turns: quadtree_levels.comp, and in C++
// render/asked_block.h.
#pragma once

#include "quadtree.h"

#ifdef __cplusplus
#define QUADTREE_SHAPE(slot) quadtree.shape(slot)
#else
#define QUADTREE_SHAPE(slot) quadtree_shapes[slot]
#endif

SHADER_BEGIN

// Squares of metres from the eye to the box about a cell: `side` samples from its corner on, the tile's
// heights.
SHADER_FUNCTION float cell_distance_squared(QuadtreeUniforms view, ivec2 corner, int side, int least,
                                            int most) {
    SHADER_PRECISE float west = float(corner.x - view.eye_cell.x) - view.eye_rest.x;
    SHADER_PRECISE float north = float(corner.y - view.eye_cell.y) - view.eye_rest.y;
    SHADER_PRECISE float east = float(corner.x + side - view.eye_cell.x) - view.eye_rest.x;
    SHADER_PRECISE float south = float(corner.y + side - view.eye_cell.y) - view.eye_rest.y;
    SHADER_PRECISE float x = max(max(west, -east), 0.0f) * view.scale.x;
    SHADER_PRECISE float y = max(max(north, -south), 0.0f) * view.scale.y;
    SHADER_PRECISE float rest = view.eye_rest.z * 16.0f;
    SHADER_PRECISE float under = float(least - 16 * view.eye_cell.z) - rest;
    SHADER_PRECISE float over = float(most - 16 * view.eye_cell.z) - rest;
    SHADER_PRECISE float z = max(max(under, -over), 0.0f) * view.eye_rest.w;
    SHADER_PRECISE float xx = x * x;
    SHADER_PRECISE float yy = y * y;
    SHADER_PRECISE float zz = z * z;
    SHADER_PRECISE float sum = xx + yy;
    sum = sum + zz;
    return sum;
}

// Within it a cell of this level and error is drawn finer; metres. Error -1: nowhere.
SHADER_FUNCTION float split_distance(QuadtreeUniforms view, int level, int error, float unit_m) {
    SHADER_PRECISE float by_error = float(error) * unit_m;
    by_error = by_error * view.scale.z;
    SHADER_PRECISE float spacing = max(view.scale.x, view.scale.y) * float(1 << level);
    SHADER_PRECISE float by_spacing = spacing * view.scale.w;
    return error >= 0 ? max(by_error, by_spacing) : 0.0f;
}

// How near a cell is, and how near it would have to be to split; squared.
struct CellSight {
    float away, reach;
};

// The cell of a depth that holds an entry, by its block's own tile, which has nothing finer than its entries.
QUADTREE_FUNCTION CellSight tile_sight(QUADTREE_PARAMETER QuadtreeUniforms view, QuadtreeBlock block,
                                       ivec2 place, int depth) {
    int level = block.coarseness + kQuadtreeDepth - depth;
    int shift = cell_shift(view, level);
    ivec2 first = block_corner(view, block);
    ivec2 corner = ivec2(first.x + ((place.x >> (kQuadtreeDepth - depth)) << shift),
                         first.y + ((place.y >> (kQuadtreeDepth - depth)) << shift));
    uint slot = block_slot(block);
    int error = depth < kQuadtreeDepth ? QUADTREE_SHAPE(slot).error[shape_index(place, depth)] : -1;
    float unit_m = block.coarseness < view.blocks.z ? view.reach.z : view.eye_rest.w;
    SHADER_PRECISE float reach = split_distance(view, level, error, unit_m);
    CellSight sight;
    sight.away = cell_distance_squared(view, corner, 1 << shift, QUADTREE_SHAPE(slot).least,
                                       QUADTREE_SHAPE(slot).most);
    reach = reach * reach;
    sight.reach = reach;
    return sight;
}

// The entry of a block above that holds one of a block's.
SHADER_FUNCTION ivec2 place_above(QuadtreeBlock block, ivec2 place, int coarseness) {
    int up = coarseness - block.coarseness, within = (1 << up) - 1;
    return ivec2(((block.node.x & within) * kQuadtreeSide + place.x) >> up,
                 ((block.node.y & within) * kQuadtreeSide + place.y) >> up);
}

// The cell about all of a block, by the tile above.
QUADTREE_FUNCTION CellSight sight_above(QUADTREE_PARAMETER QuadtreeUniforms view, QuadtreeBlock block,
                                        ivec2 place) {
    QuadtreeBlock above = QUADTREE_BLOCK(block.above);
    int depth = min(above.coarseness - block.coarseness - 1, kQuadtreeDepth);
    return tile_sight(QUADTREE view, above, place_above(block, place, above.coarseness), depth);
}

// How much of its parent's surface a cell has, in kLodSteps: all where the parent is about to be drawn instead, nothing
// where it is itself about to divide. In between from half the parent's distance on, a quarter of its square. A parent by
// the tile above may know of less error than its own part: so much more, a little less than coarser_error's eighth,
// squared, is always left to turn on.
SHADER_FUNCTION int turned_steps(CellSight own, CellSight parent) {
    SHADER_PRECISE float away = min(own.away, parent.away);
    SHADER_PRECISE float reach = max(parent.reach, 1.25f * own.reach);
    if (away >= reach) return kLodSteps;
    SHADER_PRECISE float start = max(own.reach, 0.25f * reach);
    if (away <= start) return 0;
    SHADER_PRECISE float past = (away - start) * float(kLodSteps);
    SHADER_PRECISE float width = reach - start;
    // Nobody divides alike: the quotient is a guess, and products, which everybody rounds alike, decide.
    int steps = int(past / width);
    SHADER_PRECISE float here = float(steps) * width;
    SHADER_PRECISE float next = float(steps + 1) * width;
    if (here > past) return steps - 1;
    return min(next <= past ? steps + 1 : steps, kLodSteps);
}

// What an entry asks for by its block's own tile alone: the lod of the coarsest cell about it that is far enough away for
// its error.
QUADTREE_FUNCTION int own_lod(QUADTREE_PARAMETER QuadtreeUniforms view, QuadtreeBlock block, ivec2 place) {
    CellSight own = tile_sight(QUADTREE view, block, place, 0), parent = own;
    int depth = 0;
    while (own.away < own.reach) {
        parent = own;
        ++depth;
        own = tile_sight(QUADTREE view, block, place, depth);
    }
    int lod = (block.coarseness + kQuadtreeDepth - depth) * kLodSteps;
    if (depth == 0 && block.above < 0) return lod;
    if (depth == 0) parent = sight_above(QUADTREE view, block, place);
    return lod + turned_steps(own, parent);
}

// How much a block is still like the one above, in so many steps.
SHADER_CONSTANT int kTurnSteps = 256;
SHADER_FUNCTION int like_above(QuadtreeBlock block) { return int(block.fade * float(kTurnSteps) + 0.5f); }

// What an entry asks for while its tile turns. above: the lod of the block above there; either counts only where it has a
// share.
SHADER_FUNCTION int wanted_lod(QuadtreeBlock block, int own, int above) {
    int share = like_above(block);
    return (own * (kTurnSteps - share) + above * share) / kTurnSteps;
}

// The coarsest cell about an entry in which nobody wants a finer one, and its lod: the least of those wanted. It has turned
// no farther than into its parent, which is not drawn because of others: they want just less than that when it divides.
// What is all of its block has no parent there, and may have turned farther.
struct AskedCell {
    int depth;
    int lod;
};

// The least lod wanted in a cell, by shape_index: in GLSL an array of this name, in C++ an object with a function of this
// name.
#ifdef __cplusplus
#define LEAST_FUNCTION     \
    template <class Least> \
    inline
#define LEAST_PARAMETER const Least &least,
#define LEAST_LOD(cell) least.least_lod(cell)
#else
#define LEAST_FUNCTION
#define LEAST_PARAMETER
#define LEAST_LOD(cell) least_lods[cell]
#endif

// wanted: the entry's own.
LEAST_FUNCTION AskedCell asked_cell(LEAST_PARAMETER QuadtreeBlock block, ivec2 place, int wanted) {
    AskedCell cell;
    for (cell.depth = 0; cell.depth < kQuadtreeDepth; ++cell.depth) {
        cell.lod = LEAST_LOD(shape_index(place, cell.depth));
        if (cell.lod >= (block.coarseness + kQuadtreeDepth - cell.depth) * kLodSteps) break;
    }
    if (cell.depth == kQuadtreeDepth) cell.lod = wanted;
    int parent = (block.coarseness + kQuadtreeDepth - cell.depth + 1) * kLodSteps;
    if (cell.depth > 0) cell.lod = min(cell.lod, parent);
    return cell;
}

// The level that the block can draw it with.
SHADER_FUNCTION int asked_level(QuadtreeUniforms view, QuadtreeBlock block, AskedCell cell) {
    int level = block.coarseness + kQuadtreeDepth - max(cell.depth, least_depth(block));
    return max(min(level, view.blocks.w), block.coarseness);
}

SHADER_END
