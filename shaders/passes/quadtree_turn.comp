#version 450 core
// How far each cell has turned into its parent.
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
    if (!has_entry(block, place)) return;
    uint entry = gl_GlobalInvocationID.x;
    quadtree_cells[entry].lod = lod_of(view, block, place, quadtree_cells[entry].level);
}
