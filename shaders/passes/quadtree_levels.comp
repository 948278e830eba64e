#version 450 core
// The levels that distance and error ask for: a work group a block, an invocation an entry.
#include "../shared/quadtree_blocks.h"

layout(local_size_x = kQuadtreeEntries) in;

layout(std140, binding = kQuadtreeUniformsBinding) uniform ViewBlock { QuadtreeUniforms view; };
layout(std430, binding = kQuadtreeBlocksBinding) readonly buffer BlockBlock { QuadtreeBlock quadtree_blocks[]; };
layout(std430, binding = kQuadtreePlacesBinding) readonly buffer PlaceBlock { QuadtreePlace quadtree_places[]; };
layout(std430, binding = kQuadtreeShapesBinding) readonly buffer ShapeBlock { QuadtreeShape quadtree_shapes[]; };
layout(std430, binding = kQuadtreeCellsBinding) buffer CellBlock { QuadtreeCell quadtree_cells[]; };
#include "../lib/quadtree_levels.h"

void main() {
    QuadtreeBlock block = quadtree_blocks[gl_WorkGroupID.x];
    ivec2 place = entry_place(int(gl_LocalInvocationIndex));
    int level = has_entry(block, place) ? asked_level(view, block, place) : 0;
    quadtree_cells[gl_GlobalInvocationID.x] = QuadtreeCell(level, 0);
}
