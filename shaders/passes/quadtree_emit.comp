#version 450 core
// The cells that the picture may show, as instances of one draw.
#include "../shared/quadtree_blocks.h"

layout(local_size_x = kQuadtreeEntries) in;

layout(std140, binding = kQuadtreeUniformsBinding) uniform ViewBlock { QuadtreeUniforms view; };
layout(std430, binding = kQuadtreeBlocksBinding) readonly buffer BlockBlock { QuadtreeBlock quadtree_blocks[]; };
layout(std430, binding = kQuadtreePlacesBinding) readonly buffer PlaceBlock { QuadtreePlace quadtree_places[]; };
layout(std430, binding = kQuadtreeCellsBinding) readonly buffer CellBlock { QuadtreeCell quadtree_cells[]; };
layout(std430, binding = kQuadtreeInstancesBinding) writeonly buffer InstanceBlock {
    QuadtreeInstance quadtree_instances[];
};
layout(std430, binding = kQuadtreeCommandsBinding) buffer CommandBlock { QuadtreeCommands commands; };
#include "../lib/quadtree.h"

void main() {
    // Mostly fine blocks first: they are near, and hide what is drawn behind them.
    int block = int(gl_NumWorkGroups.x - 1u - gl_WorkGroupID.x);
    ivec2 place = entry_place(int(gl_LocalInvocationIndex));
    if (!draws_cell(view, block, place)) return;
    uint at = atomicAdd(commands.cells, 1u);
    // What finds no room is taken back, so that no more are drawn than there are.
    if (at < uint(quadtree_instances.length())) {
        quadtree_instances[at] = drawn_cell(view, block, place);
    } else {
        atomicAdd(commands.cells, 0xffffffffu);
        atomicAdd(commands.left_out, 1u);
    }
}
