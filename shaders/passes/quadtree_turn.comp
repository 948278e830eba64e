#version 450 core
// The lod that each cell is drawn with: what was asked for, as far as a cell of its level can look like that.
#include "../shared/quadtree_blocks.h"

layout(local_size_x = kQuadtreeEntries) in;

layout(std140, binding = kQuadtreeUniformsBinding) uniform ViewBlock { QuadtreeUniforms view; };
layout(std430, binding = kQuadtreeBlocksBinding) readonly buffer BlockBlock { QuadtreeBlock quadtree_blocks[]; };
layout(std430, binding = kQuadtreePlacesBinding) readonly buffer PlaceBlock { QuadtreePlace quadtree_places[]; };
layout(std430, binding = kQuadtreeCellsBinding) buffer CellBlock { QuadtreeCell quadtree_cells[]; };
#include "../lib/quadtree.h"

void main() {
    QuadtreeCell cell = quadtree_cells[gl_GlobalInvocationID.x];
    cell.lod = drawn_lod(view, quadtree_blocks[gl_WorkGroupID.x], cell.lod, cell.level);
    quadtree_cells[gl_GlobalInvocationID.x] = cell;
}
