// The level that a cell asks for, and how far it has turned into its parent: by how near the eye is, and how wrong
// the cell is drawn.
//
// A tile that has just come looks like the one above it, and turns into its own look (disc.h, ring_height). How near its
// cells must be to divide turns along: what is not seen yet divides nothing, and a level that changes has somewhere to
// turn from. A block without a tile of its own is as the one above it throughout.
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

// A block's entry, as that of the nearest block above which has a tile of its own; and a depth's there.
struct QuadtreePart {
    QuadtreeBlock block;
    ivec2 place;
    int depth;
};

QUADTREE_FUNCTION QuadtreePart part_above(QUADTREE_PARAMETER QuadtreePart part) {
    QuadtreePart above;
    above.block = QUADTREE_BLOCK(part.block.above);
    int up = above.block.coarseness - part.block.coarseness, within = (1 << up) - 1;
    above.place = ivec2(((part.block.node.x & within) * kQuadtreeSide + part.place.x) >> up,
                        ((part.block.node.y & within) * kQuadtreeSide + part.place.y) >> up);
    above.depth = min(part.depth + up, kQuadtreeDepth);
    return above;
}

// The same, as far as the tile has turned: the rest is the tile's above, as far as that has. Depth -1: the cell about
// all of the block, where there is a tile above.
QUADTREE_FUNCTION CellSight cell_sight(QUADTREE_PARAMETER QuadtreeUniforms view, QuadtreeBlock block,
                                       ivec2 place, int depth) {
    QuadtreePart part;
    part.block = block;
    part.place = place;
    part.depth = depth;
    if (depth < 0) part = part_above(QUADTREE part);
    CellSight sum;
    sum.away = sum.reach = 0.0f;
    SHADER_PRECISE float rest = 1.0f;
    for (;;) {
        SHADER_PRECISE float above = rest * part.block.fade;
        SHADER_PRECISE float own = rest - above;
        if (own > 0.0f) {
            CellSight sight = tile_sight(QUADTREE view, part.block, part.place, part.depth);
            SHADER_PRECISE float away = own * sight.away;
            SHADER_PRECISE float reach = own * sight.reach;
            away = away + sum.away;
            reach = reach + sum.reach;
            sum.away = away;
            sum.reach = reach;
        }
        if (above <= 0.0f) return sum;
        rest = above;
        part = part_above(QUADTREE part);
    }
}

// The level that distance and error ask for.
QUADTREE_FUNCTION int asked_level(QUADTREE_PARAMETER QuadtreeUniforms view, QuadtreeBlock block,
                                  ivec2 place) {
    int depth = least_depth(block);
    for (; depth < kQuadtreeDepth; ++depth) {
        CellSight sight = cell_sight(QUADTREE view, block, place, depth);
        if (sight.away >= sight.reach) break;
    }
    return max(min(block.coarseness + kQuadtreeDepth - depth, view.blocks.w), block.coarseness);
}

// How much of its parent's surface a cell has: all where the parent is about to be drawn instead, nothing where
// it is itself about to divide. In between from half the parent's distance on, a quarter of its square. A parent by the
// tile above may know of less error than its own part: so much more, a little less than coarser_error's eighth,
// squared, is always left to turn on.
SHADER_FUNCTION float turned_of(CellSight own, CellSight parent) {
    float away = min(own.away, parent.away), reach = max(parent.reach, 1.25f * own.reach);
    if (away >= reach) return 1.0f;
    float start = max(own.reach, 0.25f * reach);
    return clamp((away - start) / (reach - start), 0.0f, 1.0f);
}

// How far a cell of a level has turned into its parent, in kLodSteps. What is only finer for its neighbours' sake, or
// because its block is, is as the parent throughout.
QUADTREE_FUNCTION int free_lod(QUADTREE_PARAMETER QuadtreeUniforms view, QuadtreeBlock block, ivec2 place,
                               int level) {
    int depth = block.coarseness + kQuadtreeDepth - level;
    if (depth == 0 && block.above < 0) return level * kLodSteps;
    CellSight parent = cell_sight(QUADTREE view, block, place, depth - 1);
    CellSight own = parent;
    own.reach = 0.0f;
    if (depth < kQuadtreeDepth) own = cell_sight(QUADTREE view, block, place, depth);
    float turned = turned_of(own, parent);
    return level * kLodSteps + int(turned * float(kLodSteps));
}

// The same while the tile turns, whose finest level comes by and by; and where chunks draw the rest of the ground: cells
// meet it as the source's samples, unturned.
QUADTREE_FUNCTION int lod_of(QUADTREE_PARAMETER QuadtreeUniforms view, QuadtreeBlock block, ivec2 place,
                             int level) {
    int coarsest = view.blocks.w * kLodSteps;
    int finest = block.coarseness * kLodSteps + int(block.fade * float(kLodSteps));
    return is_shown(block) ? min(max(free_lod(QUADTREE view, block, place, level), finest), coarsest)
                           : coarsest;
}

SHADER_END
