// What the cells of a tile are like: how wrong each is when it is drawn coarse (gpu-quadtree paper, 3.2: local roughness,
// made exact), in whole numbers.
//
// A cell's corners have heights of their own level, which are filtered: a quarter of each neighbour's at the level's spacing,
// half of their own, both ways. Half of what a sample lies beside the middle of its neighbours, that is, either way; and that
// it is beside them says the error at twice the spacing. So the error is that of leaving samples out, and that of the next
// coarser level besides.
#pragma once

#include "../shared/disc_uniforms.h"
#include "../shared/quadtree_blocks.h"
#include "quadtree_entries.h"

#ifdef __cplusplus
#define SHAPE_FUNCTION      \
    template <class Texels> \
    inline
#define SHAPE_PARAMETER const Texels &texels,
#define SHAPE texels,
#define SHAPE_TEXEL(at) texels.texel(at)
#else
#define SHAPE_FUNCTION
#define SHAPE_PARAMETER int slot,
#define SHAPE slot,
#define SHAPE_TEXEL(at) texelFetch(height_tiles, ivec3(at, slot), 0).x
#endif

SHADER_BEGIN

// Sixteenths of a quantum: io/pager/heights_texels.h.
SHAPE_FUNCTION int shape_height(SHAPE_PARAMETER ivec2 at) {
    return SHAPE_TEXEL(ivec2(at.x + kHeightApron, at.y + kHeightApron)) >> 1;
}

// By how much a sample lies beside the triangles whose corners are every `spacing`-th sample; rounded up. quads: of the tile.
SHAPE_FUNCTION int sample_error(SHAPE_PARAMETER ivec2 at, int spacing, int quads) {
    ivec2 corner =
        ivec2(min(at.x & ~(spacing - 1), quads - spacing), min(at.y & ~(spacing - 1), quads - spacing));
    int u = at.x - corner.x, v = at.y - corner.y;
    int base = shape_height(SHAPE corner);
    int ne = shape_height(SHAPE ivec2(corner.x + spacing, corner.y)) - base;
    int sw = shape_height(SHAPE ivec2(corner.x, corner.y + spacing)) - base;
    int se = shape_height(SHAPE ivec2(corner.x + spacing, corner.y + spacing)) - base;
    int off = (shape_height(SHAPE at) - base) * spacing;
    // Quads meet in fans, two by two: disc.h, coarse_diagonal.
    bool from_north_west = (((corner.x / spacing) ^ (corner.y / spacing)) & 1) == 0;
    if (from_north_west)
        off -= u >= v ? ne * (u - v) + se * v : sw * (v - u) + se * u;
    else
        off -= u + v <= spacing ? ne * u + sw * v
                                : se * (u + v - spacing) + sw * (spacing - u) + ne * (spacing - v);
    return (abs(off) + spacing - 1) / spacing;
}

// The largest error of an entry's samples in the cells of a depth, and what they reach.
struct EntryShape {
    int error[3];
    int least, most;
};

SHAPE_FUNCTION EntryShape entry_shape(SHAPE_PARAMETER ivec2 place, int quads) {
    EntryShape shape;
    // Every second, fourth, eighth and sixteenth sample being a corner.
    int apart[4];
    for (int i = 0; i < 4; ++i) apart[i] = 0;
    int side = quads / kQuadtreeSide;
    ivec2 first = ivec2(place.x * side, place.y * side);
    shape.least = shape_height(SHAPE first);
    shape.most = shape.least;
    for (int i = 0; i < (side + 1) * (side + 1); ++i) {
        ivec2 at = ivec2(first.x + i % (side + 1), first.y + i / (side + 1));
        int height = shape_height(SHAPE at);
        shape.least = min(shape.least, height);
        shape.most = max(shape.most, height);
        for (int k = 0; k < 4; ++k) apart[k] = max(apart[k], sample_error(SHAPE at, 2 << k, quads));
    }
    for (int depth = 0; depth < kQuadtreeDepth; ++depth)
        shape.error[depth] = apart[2 - depth] + apart[3 - depth];
    // What is drawn coarser is no better.
    shape.error[1] = max(shape.error[1], shape.error[2]);
    shape.error[0] = max(shape.error[0], shape.error[1]);
    return shape;
}

SHADER_END
