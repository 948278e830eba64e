// The quadtree of the quadtree surface: which cells of the ground are drawn, and how their borders meet.
//
// Literature: quadtrees built, balanced and morphed by the GPU (gpu-quadtree paper, 3.1-3.4), one a logical
// block, with a matrix of levels. How we differ: docs/quadtree.md.
//
// A cell of level k is square, of quads of 2^k samples, an eighth of a tile's to a side; cells lie on one
// lattice for the whole ground, whatever tiles are there. A block is a tile's ground: cells of four levels,
// the finest of which has the tile's own spacing. Levels are kept by entry, a finest cell of the block. All
// that decides a level is integers, and additions and multiplications that are not contracted, so that a CPU
// finds the same levels.
#pragma once

#include "../shared/quadtree_blocks.h"
#include "quadtree_entries.h"

// Where blocks, places, levels and shapes (quadtree_levels.h) come from: in GLSL buffers of these names, in C++ an object with
// functions of these names.
#ifdef __cplusplus
#define QUADTREE_FUNCTION     \
    template <class Quadtree> \
    inline
#define QUADTREE_PARAMETER const Quadtree &quadtree,
#define QUADTREE quadtree,
#define QUADTREE_BLOCK(i) quadtree.block(i)
#define QUADTREE_PLACE(i) quadtree.place(i)
#define QUADTREE_LEVEL(i) quadtree.level(i)
#define QUADTREE_LOD(i) quadtree.lod(i)
#else
#define QUADTREE_FUNCTION
#define QUADTREE_PARAMETER
#define QUADTREE
#define QUADTREE_BLOCK(i) quadtree_blocks[i]
#define QUADTREE_PLACE(i) quadtree_places[i]
#define QUADTREE_LEVEL(i) quadtree_cells[i].level
#define QUADTREE_LOD(i) quadtree_cells[i].lod
#endif

SHADER_BEGIN

// --- blocks

SHADER_FUNCTION uint block_slot(QuadtreeBlock block) { return block.slot_and_quarters >> 6u; }
// By cells, not by chunks.
SHADER_FUNCTION bool is_shown(QuadtreeBlock block) { return (block.slot_and_quarters & 32u) == 0u; }
SHADER_FUNCTION bool has_own_tile(QuadtreeBlock block) { return (block.slot_and_quarters & 16u) != 0u; }
// A side's samples, as a shift.
SHADER_FUNCTION int cell_shift(QuadtreeUniforms view, int level) { return level + view.eye_cell.w; }
SHADER_FUNCTION int block_shift(QuadtreeUniforms view, int coarseness) {
    return cell_shift(view, coarseness) + kQuadtreeDepth;
}
SHADER_FUNCTION ivec2 block_corner(QuadtreeUniforms view, QuadtreeBlock block) {
    int shift = block_shift(view, block.coarseness);
    return ivec2(block.node.x << shift, block.node.y << shift);
}
SHADER_FUNCTION ivec2 entry_corner(QuadtreeUniforms view, QuadtreeBlock block, ivec2 place) {
    ivec2 first = block_corner(view, block);
    int shift = cell_shift(view, block.coarseness);
    return ivec2(first.x + (place.x << shift), first.y + (place.y << shift));
}
// Whether an entry is the north-western one of its cell, which has this level.
SHADER_FUNCTION bool is_corner(QuadtreeBlock block, ivec2 place, int level) {
    int within = (1 << (level - block.coarseness)) - 1;
    return (place.x & within) == 0 && (place.y & within) == 0;
}

// Whether an entry lies in a quarter that is the block's to draw.
SHADER_FUNCTION bool has_entry(QuadtreeBlock block, ivec2 place) {
    int quarter = (place.x >> 2) + 2 * (place.y >> 2);
    return ((block.slot_and_quarters >> uint(quarter)) & 1u) != 0u;
}

// A block that has not all its quarters has no cell of its own size.
SHADER_FUNCTION int least_depth(QuadtreeBlock block) {
    return (block.slot_and_quarters & 15u) == 15u ? 0 : 1;
}

SHADER_FUNCTION uint place_hash(ivec2 node, int coarseness) {
    uint hash = uint(node.x) * 0x9e3779b1u + uint(node.y) * 0x85ebca77u + uint(coarseness) * 0xc2b2ae3du;
    return hash ^ (hash >> 15u);
}

// A place's block and entry; block -1 where there is none.
struct QuadtreeEntry {
    int block;
    ivec2 place;
};

QUADTREE_FUNCTION int block_at(QUADTREE_PARAMETER QuadtreeUniforms view, ivec2 node, int coarseness) {
    uint mask = (1u << uint(view.blocks.x)) - 1u;
    uint wanted = uint(node.x) | (uint(node.y) << 16u);
    for (uint probe = place_hash(node, coarseness) & mask;; probe = (probe + 1u) & mask) {
        QuadtreePlace found = QUADTREE_PLACE(probe);
        if (found.block_and_coarseness == 0u) return -1;
        if (found.node == wanted && int(found.block_and_coarseness & 31u) == coarseness)
            return int(found.block_and_coarseness >> 5u) - 1;
    }
}

// The finest that has it, of blocks of some coarsenesses.
QUADTREE_FUNCTION QuadtreeEntry entry_among(QUADTREE_PARAMETER QuadtreeUniforms view, ivec2 sample_at,
                                            int finest, int coarsest) {
    QuadtreeEntry entry;
    entry.block = -1;
    // Cells may reach over the far border.
    if (sample_at.x < 0 || sample_at.y < 0) return entry;
    for (int c = max(finest, 0); c <= min(coarsest, view.blocks.y); ++c) {
        int shift = block_shift(view, c), within = cell_shift(view, c);
        int block = block_at(QUADTREE view, ivec2(sample_at.x >> shift, sample_at.y >> shift), c);
        if (block < 0) continue;
        ivec2 place = ivec2((sample_at.x >> within) & (kQuadtreeSide - 1),
                            (sample_at.y >> within) & (kQuadtreeSide - 1));
        if (!has_entry(QUADTREE_BLOCK(block), place)) continue;
        entry.block = block;
        entry.place = place;
        return entry;
    }
    return entry;
}

// The finest that has it.
QUADTREE_FUNCTION QuadtreeEntry entry_of(QUADTREE_PARAMETER QuadtreeUniforms view, ivec2 sample_at) {
    return entry_among(QUADTREE view, sample_at, 0, view.blocks.y);
}

// The same at a sample beside one that a block draws: blocks side by side are no more than a level apart.
QUADTREE_FUNCTION QuadtreeEntry entry_beside(QUADTREE_PARAMETER QuadtreeUniforms view, ivec2 sample_at,
                                             int coarseness) {
    return entry_among(QUADTREE view, sample_at, coarseness - 1, coarseness + 1);
}

// --- lods: a cell's level and how far it has turned into its parent, kLodSteps a level

// So many levels a cell may have turned: that corners, which neighbours of the next level share, still lie on the lattice of
// what they turn into, and vertices need to know no more than their parents' parents (quadtree_vertex.h).
SHADER_FUNCTION int most_turned(QuadtreeUniforms view) { return min(view.eye_cell.w - 1, 2); }

// The lod that a cell is drawn with whose entries asked for one: balancing may have made it finer than that, but it looks
// the same. Where chunks draw the rest of the ground cells meet it as the source's samples, unturned.
SHADER_FUNCTION int drawn_lod(QuadtreeUniforms view, QuadtreeBlock block, int asked, int level) {
    int coarsest = view.blocks.w * kLodSteps;
    int most = min((level + most_turned(view)) * kLodSteps, coarsest);
    return is_shown(block) ? min(asked, most) : coarsest;
}

// --- borders

// How coarse the cell at a sample beside one of a level is; 0 where there is none. The level is that of the other's
// block, or up to the depth coarser.
QUADTREE_FUNCTION int lod_at(QUADTREE_PARAMETER QuadtreeUniforms view, ivec2 sample_at, int level) {
    QuadtreeEntry entry = entry_among(QUADTREE view, sample_at, level - kQuadtreeDepth - 1, level + 1);
    return entry.block < 0 ? 0 : QUADTREE_LOD(entry.block * kQuadtreeEntries + entry_at(entry.place));
}

// Samples about a cell of a side, counted from its corner, clockwise from the north-western one: beside each of its corners,
// then beside the first and the last sample of the side that begins there. Whatever touches the cell has one of them.
SHADER_FUNCTION ivec2 sample_about(int i, int side) {
    int of_side = i / 3, along = i % 3 == 0 ? -1 : i % 3 == 1 ? 0 : side - 1;
    return of_side == 0   ? ivec2(along, -1)
           : of_side == 1 ? ivec2(side, along)
           : of_side == 2 ? ivec2(side - 1 - along, side)
                          : ivec2(-1, side - 1 - along);
}

// The cell of a level whose corner is at a sample, with what lies about it.
QUADTREE_FUNCTION QuadtreeInstance instance_of(QUADTREE_PARAMETER QuadtreeUniforms view, ivec2 corner,
                                               int level, int lod) {
    int side = 1 << cell_shift(view, level);
    // At least as coarse as it is itself.
    int about[12];
    for (int i = 0; i < 12; ++i) {
        ivec2 at = sample_about(i, side);
        at = ivec2(corner.x + at.x, corner.y + at.y);
        about[i] = max(lod, lod_at(QUADTREE view, at, level)) - level * kLodSteps;
    }
    QuadtreeInstance made;
    made.corner = corner;
    made.level = level;
    made.lod = uint(lod);
    for (int i = 0; i < 4; ++i) {
        int first = about[3 * i + 1], last = about[3 * i + 2];
        int begins = max(max(about[3 * i], first), about[(3 * i + 11) % 12]);
        made.border[i] =
            uint(begins) | (uint(first) << uint(kBorderBits)) | (uint(last) << uint(2 * kBorderBits));
    }
    return made;
}

// Whether the picture may show some of a cell: no plane has all of the box about it on its far side.
SHADER_FUNCTION bool cell_in_view(QuadtreeUniforms view, ivec2 corner, int level) {
    float side = float(1 << cell_shift(view, level));
    float west = (float(corner.x - view.eye_cell.x) - view.eye_rest.x) * view.scale.x;
    float north = -(float(corner.y - view.eye_cell.y) - view.eye_rest.y) * view.scale.y;
    float east = west + side * view.scale.x, south = north - side * view.scale.y;
    for (int i = 0; i < 6; ++i) {
        vec4 plane = view.planes[i];
        float x = plane.x > 0.0f ? east : west;
        float y = plane.y > 0.0f ? north : south;
        float z = plane.z > 0.0f ? view.reach.y : view.reach.x;
        if (plane.x * x + plane.y * y + plane.z * z + plane.w < 0.0f) return false;
    }
    return true;
}

// Whether a cell lies on the border of a node of the source's finest level, beyond which chunks may draw.
SHADER_FUNCTION bool may_meet_chunks(QuadtreeUniforms view, ivec2 corner, int level) {
    if (view.blocks.w == kQuadtreeAnyLevel) return false;
    int node = 1 << block_shift(view, view.blocks.w), last = node - (1 << cell_shift(view, level));
    ivec2 within = ivec2(corner.x & (node - 1), corner.y & (node - 1));
    return within.x == 0 || within.y == 0 || within.x == last || within.y == last;
}

// Along such a border a cell reaches as far as its node: quadtree_seam.h.
SHADER_FUNCTION bool drawn_in_view(QuadtreeUniforms view, ivec2 corner, int level) {
    if (!may_meet_chunks(view, corner, level)) return cell_in_view(view, corner, level);
    int shift = block_shift(view, view.blocks.w);
    ivec2 node = ivec2(corner.x >> shift << shift, corner.y >> shift << shift);
    return cell_in_view(view, node, view.blocks.w + kQuadtreeDepth);
}

// The number and one of the block on whose border a cell lies; 0: it lies on none.
QUADTREE_FUNCTION uint seam_of(QUADTREE_PARAMETER QuadtreeUniforms view, ivec2 corner, int level) {
    if (!may_meet_chunks(view, corner, level)) return 0u;
    int shift = block_shift(view, view.blocks.w);
    return uint(block_at(QUADTREE view, ivec2(corner.x >> shift, corner.y >> shift), view.blocks.w) + 1);
}

// Whether the picture may show a cell of which this entry is the first: one entry speaks for each.
QUADTREE_FUNCTION bool draws_cell(QUADTREE_PARAMETER QuadtreeUniforms view, int block, ivec2 place) {
    QuadtreeBlock held = QUADTREE_BLOCK(block);
    int level = QUADTREE_LEVEL(block * kQuadtreeEntries + entry_at(place));
    return is_shown(held) && has_entry(held, place) && is_corner(held, place, level) &&
           drawn_in_view(view, entry_corner(view, held, place), level);
}

// As it is drawn.
QUADTREE_FUNCTION QuadtreeInstance drawn_cell(QUADTREE_PARAMETER QuadtreeUniforms view, int block,
                                              ivec2 place) {
    int entry = block * kQuadtreeEntries + entry_at(place);
    ivec2 corner = entry_corner(view, QUADTREE_BLOCK(block), place);
    int level = QUADTREE_LEVEL(entry);
    QuadtreeInstance made = instance_of(QUADTREE view, corner, level, QUADTREE_LOD(entry));
    made.lod |= seam_of(QUADTREE view, corner, level) << 16u;
    return made;
}

SHADER_END
