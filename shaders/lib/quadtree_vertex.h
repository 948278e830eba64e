// The vertices of a drawn cell: where they stand, so that cells of all levels are one surface.
//
// Literature: in the gpu-quadtree paper (3.4) a cell that borders a coarser one leaves out every second
// vertex of that border. Here the vertex moves to where the coarser cell has one, and its height is the
// coarser one's: docs/quadtree.md.
#pragma once

#include "../shared/quadtree_blocks.h"

SHADER_BEGIN

// A vertex: where it stands, of which level its surface is, and how far that has turned into the next: more than 1, and it
// is on the way to the one after that.
struct QuadtreeVertex {
    ivec2 cell;
    int level;
    float turned;
};

// Of a place on the border; columns and rows of quads. Where the halves of a side meet, smaller cells may meet, too.
SHADER_FUNCTION int border_lod(QuadtreeInstance cell, ivec2 at, int quads) {
    int side = at.y == 0 && at.x < quads       ? 0
               : at.x == quads && at.y < quads ? 1
               : at.y == quads && at.x > 0     ? 2
                                               : 3;
    int along = side == 0 ? at.x : side == 1 ? at.y : side == 2 ? quads - at.x : quads - at.y;
    uint about = cell.border[side], bits = (1u << uint(kBorderBits)) - 1u;
    int first = int((about >> uint(kBorderBits)) & bits), last = int((about >> uint(2 * kBorderBits)) & bits);
    int lod = along == 0          ? int(about & bits)
              : 2 * along < quads ? first
              : 2 * along > quads ? last
                                  : max(first, last);
    return cell.level * kLodSteps + lod;
}

// at: columns and rows, 0 to `quads`. Levels of neighbours differ by no more than one, and no cell has turned farther than
// most_turned, so a corner stands on the lattice of all that touch it. A vertex on a border is as coarse as the coarsest
// cell that it touches, and stands where that has one: whoever draws it.
SHADER_FUNCTION QuadtreeVertex quadtree_vertex(QuadtreeInstance cell, ivec2 at, int quads) {
    bool east_west = at.x == 0 || at.x == quads, north_south = at.y == 0 || at.y == quads;
    bool on_border = east_west || north_south;
    ivec2 place = at;
    if (east_west != north_south) {
        int skipped = border_lod(cell, at, quads) / kLodSteps - cell.level;
        int kept = ~((1 << skipped) - 1);
        // Along the border: where that is coarser than the cell is wide, to the corner, which follows what lies beyond.
        place = east_west ? ivec2(at.x, at.y & kept) : ivec2(at.x & kept, at.y);
    }
    // What has come to stand on a corner is one, and in a side's middle likewise.
    int lod = on_border ? border_lod(cell, place, quads) : int(cell.lod & 0xffffu);
    QuadtreeVertex vertex;
    vertex.level = on_border ? lod / kLodSteps : cell.level;
    vertex.turned = float(lod - vertex.level * kLodSteps) / float(kLodSteps);
    vertex.cell = ivec2(cell.corner.x + (place.x << cell.level), cell.corner.y + (place.y << cell.level));
    return vertex;
}

SHADER_END
