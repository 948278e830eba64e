// Where cells meet chunks: on the border of a node of the source's finest level, a cell's vertices stand where the
// chunk beyond has some.
//
// A chunk's border has only some of the source's samples (horizon paper, 3.1). A vertex between two of them moves along
// the border to the one before: the cell's first row of quads becomes fans, which fold nowhere because places keep
// their order. Its height is that sample's in the tile as in the chunk. docs/detail.md.
#pragma once

#include "../shared/quadtree_blocks.h"

// Where the places of chunks' vertices come from, kSeamWords a side, four sides a block (west, east, north, south),
// a bit a sample: in GLSL a buffer of this name, in C++ an object with a function of this name.
#ifdef __cplusplus
#define SEAM_FUNCTION      \
    template <class Seams> \
    inline
#define SEAM_PARAMETER const Seams &seams,
#define SEAM_WORD(i) seams.word(i)
#define SEAMS seams,
#else
#define SEAM_FUNCTION
#define SEAM_PARAMETER
#define SEAM_WORD(i) quadtree_seams[i]
#define SEAMS
#endif

SHADER_BEGIN

SHADER_FUNCTION int highest_bit(uint bits) {
    int highest = 0;
    for (int shift = 16; shift > 0; shift >>= 1)
        if ((bits >> uint(highest + shift)) != 0u) highest += shift;
    return highest;
}

// The last place at or before one that a chunk has, -1 without a chunk: the first is in every one. side: as io::Side
// counts them.
SEAM_FUNCTION int place_on_seam(SEAM_PARAMETER int block, int side, int at) {
    int first = (4 * block + side) * kSeamWords;
    for (int word = at >> 5; word >= 0; --word) {
        uint kept = word == at >> 5 ? (2u << uint(at & 31)) - 1u : 0xffffffffu;
        uint found = SEAM_WORD(first + word) & kept;
        if (found != 0u) return 32 * word + highest_bit(found);
    }
    return -1;
}

// Where a cell's vertex stands, by where it stood: whatever cell it belongs to, what lies on a border follows it.
// source: the coarseness of the source's finest samples; node_shift: log2 of a node's side there, in the lattice's.
SEAM_FUNCTION ivec2 seamed_place(SEAM_PARAMETER QuadtreeInstance cell, ivec2 place, int source,
                                 int node_shift) {
    uint seam = cell.lod >> 16u;
    if (seam == 0u) return place;
    ivec2 node = ivec2(cell.corner.x >> node_shift << node_shift, cell.corner.y >> node_shift << node_shift);
    ivec2 within = ivec2(place.x - node.x, place.y - node.y);
    int last = 1 << node_shift;
    bool west_east = within.x == 0 || within.x == last, north_south = within.y == 0 || within.y == last;
    // A node's corner is in every chunk.
    if (west_east == north_south) return place;
    int side = west_east ? (within.x == 0 ? 0 : 1) : (within.y == 0 ? 2 : 3);
    int kept = place_on_seam(SEAMS int(seam) - 1, side, (west_east ? within.y : within.x) >> source);
    if (kept < 0) return place;
    return west_east ? ivec2(place.x, node.y + (kept << source)) : ivec2(node.x + (kept << source), place.y);
}

SHADER_END
