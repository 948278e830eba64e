// The vertices of a drawn cell: where they stand, so that cells of all levels are one surface.
//
// Literature: in the gpu-quadtree paper (3.4) a cell that borders a coarser one leaves out every second
// vertex of that border. Here the vertex moves to where the coarser cell has one, and its height is the
// coarser one's: docs/quadtree.md.
#pragma once

#include "../shared/quadtree_blocks.h"

SHADER_BEGIN

// A vertex: where it stands, of which level its surface is, and how much of the next it has.
struct QuadtreeVertex {
    ivec2 cell;
    int level;
    float turned;
};

SHADER_FUNCTION uint corner_lod(QuadtreeInstance cell, ivec2 at) {
    uint corners = cell.corners[at.y == 0 ? 0 : 1];
    return at.x == 0 ? corners & 0xffffu : corners >> 16u;
}
// Of a border that is no corner.
SHADER_FUNCTION uint side_lod(QuadtreeInstance cell, ivec2 at, int quads) {
    if (at.x == 0) return cell.sides[0] & 0xffffu;
    if (at.y == 0) return cell.sides[0] >> 16u;
    return at.x == quads ? cell.sides[1] & 0xffffu : cell.sides[1] >> 16u;
}

// at: columns and rows, 0 to `quads`. Levels of neighbours differ by no more than one, so a corner stands on
// the lattice of all that touch it. A vertex on a border is as coarse as the coarsest cell that it touches,
// and stands where that has one: whoever draws it.
SHADER_FUNCTION QuadtreeVertex quadtree_vertex(QuadtreeInstance cell, ivec2 at, int quads) {
    bool east_west = at.x == 0 || at.x == quads, north_south = at.y == 0 || at.y == quads;
    ivec2 place = at;
    if (east_west != north_south) {
        int skipped = int(side_lod(cell, at, quads)) / kLodSteps - cell.level;
        int kept = ~((1 << skipped) - 1);
        place = ivec2(at.x & kept, at.y & kept);
    }
    // What has come to stand on a corner is one.
    bool on_side = place.x == 0 || place.x == quads || place.y == 0 || place.y == quads;
    bool on_corner = (place.x == 0 || place.x == quads) && (place.y == 0 || place.y == quads);
    uint lod = on_corner ? corner_lod(cell, place)
               : on_side ? side_lod(cell, place, quads)
                         : cell.lod & 0xffffu;
    QuadtreeVertex vertex;
    vertex.level = on_side ? int(lod) / kLodSteps : cell.level;
    vertex.turned = float(int(lod) - vertex.level * kLodSteps) / float(kLodSteps);
    vertex.cell = ivec2(cell.corner.x + (place.x << cell.level), cell.corner.y + (place.y << cell.level));
    return vertex;
}

SHADER_END
