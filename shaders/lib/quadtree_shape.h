// What the cells of a tile are like: how wrong each is when it is drawn coarse (gpu-quadtree paper, 3.2: local
// roughness), in whole numbers.
//
// A cell's corners have heights of their own level, which are filtered: of each neighbour at the level's spacing a
// quarter, of their own half, both ways (io/pager/heights_texels.h). Levels coarser than the coarsest tiles have those
// tiles' heights. The error is how far a tile's samples lie beside the triangles between such corners. Exact for finest
// tiles: the samples of others are filtered already, which stands in for the source's. Past a tile's apron its last
// samples repeat.
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

// The least that a cell's error counts for, by that of a part of it: no better, and an eighth more, so that there
// is a way on which the part turns into the cell before the cell turns into what is coarser still.
SHADER_FUNCTION int coarser_error(int finer) { return finer + ((finer + 7) >> 3); }

// Sixteenths of a quantum (io/pager/heights_texels.h), or a made tile's units.
SHAPE_FUNCTION int shape_height(SHAPE_PARAMETER ivec2 at) {
    return SHAPE_TEXEL(ivec2(at.x + kHeightApron, at.y + kHeightApron)) >> 1;
}

// A tile: quads of its side, and its node's level, so many of which lie above it. Of those so many as are `unfiltered`
// have its very samples: made tiles' parents, and the source's finest. made_shift: of a made tile log2 of its heights'
// units to a quantum (detail_texels.h), of others -1.
struct ShapeTile {
    int quads, level, unfiltered, made_shift;
};

// What a level of this spacing has at one of its corners.
SHAPE_FUNCTION int corner_height(SHAPE_PARAMETER ShapeTile tile, ivec2 corner, int spacing) {
    int most = tile.quads + kHeightApron;
    int middle = shape_height(SHAPE corner);
    if (tile.level == 0 || spacing <= (1 << tile.unfiltered)) return middle;
    int apart = min(spacing, 1 << min(tile.level, kQuadtreeDepth));
    int sum = 0;
    for (int i = 0; i < 9; ++i) {
        int x = i % 3 - 1, y = i / 3 - 1;
        ivec2 beside = ivec2(clamp(corner.x + x * apart, -kHeightApron, most),
                             clamp(corner.y + y * apart, -kHeightApron, most));
        sum += (2 - abs(x)) * (2 - abs(y)) * (shape_height(SHAPE beside) - middle);
    }
    return middle + (sum >> 4);
}

// A quad of a level: its corner and spacing, and the heights of the others over that one's.
struct ShapeQuad {
    ivec2 corner;
    int spacing;
    int base, ne, sw, se;
};

// The one that has a sample.
SHAPE_FUNCTION ShapeQuad quad_about(SHAPE_PARAMETER ShapeTile tile, ivec2 at, int spacing) {
    ShapeQuad quad;
    quad.corner = ivec2(at.x & ~(spacing - 1), at.y & ~(spacing - 1));
    quad.spacing = spacing;
    int east = quad.corner.x + spacing, south = quad.corner.y + spacing;
    quad.base = corner_height(SHAPE tile, quad.corner, spacing);
    quad.ne = corner_height(SHAPE tile, ivec2(east, quad.corner.y), spacing) - quad.base;
    quad.sw = corner_height(SHAPE tile, ivec2(quad.corner.x, south), spacing) - quad.base;
    quad.se = corner_height(SHAPE tile, ivec2(east, south), spacing) - quad.base;
    return quad;
}

// By how much a sample within a quad lies beside its triangles; rounded up.
SHAPE_FUNCTION int sample_error(SHAPE_PARAMETER ShapeQuad quad, ivec2 at) {
    int spacing = quad.spacing, u = at.x - quad.corner.x, v = at.y - quad.corner.y;
    int off = (shape_height(SHAPE at) - quad.base) * spacing;
    // Quads meet in fans, two by two: disc.h, coarse_diagonal.
    bool from_north_west = (((quad.corner.x / spacing) ^ (quad.corner.y / spacing)) & 1) == 0;
    if (from_north_west)
        off -= u >= v ? quad.ne * (u - v) + quad.se * v : quad.sw * (v - u) + quad.se * u;
    else
        off -= u + v <= spacing
                   ? quad.ne * u + quad.sw * v
                   : quad.se * (u + v - spacing) + quad.sw * (spacing - u) + quad.ne * (spacing - v);
    return (abs(off) + spacing - 1) / spacing;
}

// The largest error of the samples of a square in the quad about them: `side` of them, and one more, each
// way.
SHAPE_FUNCTION int square_error(SHAPE_PARAMETER ShapeTile tile, ivec2 first, int side, int spacing) {
    ShapeQuad quad = quad_about(SHAPE tile, first, spacing);
    int most = 0;
    for (int v = 0; v <= side; ++v)
        for (int u = 0; u <= side; ++u)
            most = max(most, sample_error(SHAPE quad, ivec2(first.x + u, first.y + v)));
    return most;
}

// Sixteenths of a quantum that are no higher than a tile's height.
SHADER_FUNCTION int sixteenths_under(ShapeTile tile, int height) {
    if (tile.made_shift < 0) return height;
    return tile.made_shift >= 4 ? height >> (tile.made_shift - 4) : height << (4 - tile.made_shift);
}

// The largest error of an entry's samples in the cells of a depth, and what they reach.
struct EntryShape {
    int error[3];
    int least, most;
};

SHAPE_FUNCTION EntryShape entry_shape(SHAPE_PARAMETER ShapeTile tile, ivec2 place) {
    EntryShape shape;
    int side = tile.quads / kQuadtreeSide;
    ivec2 first = ivec2(place.x * side, place.y * side);
    shape.least = shape_height(SHAPE first);
    shape.most = shape.least;
    for (int i = 0; i < (side + 1) * (side + 1); ++i) {
        int height = shape_height(SHAPE ivec2(first.x + i % (side + 1), first.y + i / (side + 1)));
        shape.least = min(shape.least, height);
        shape.most = max(shape.most, height);
    }
    shape.least = sixteenths_under(tile, shape.least);
    shape.most = -sixteenths_under(tile, -shape.most);
    for (int depth = 0; depth < kQuadtreeDepth; ++depth) {
        int spacing = kQuadtreeSide >> depth;
        int step = min(spacing, side), steps = side / step;
        shape.error[depth] = 0;
        for (int i = 0; i < steps * steps; ++i) {
            ivec2 corner = ivec2(first.x + (i % steps) * step, first.y + (i / steps) * step);
            shape.error[depth] = max(shape.error[depth], square_error(SHAPE tile, corner, step, spacing));
        }
    }
    shape.error[1] = max(shape.error[1], coarser_error(shape.error[2]));
    shape.error[0] = max(shape.error[0], coarser_error(shape.error[1]));
    return shape;
}

SHADER_END
