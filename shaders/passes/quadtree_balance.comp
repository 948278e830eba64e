#version 450 core
// One pass of bringing neighbours within a level.
#include "../shared/quadtree_blocks.h"

layout(local_size_x = kQuadtreeEntries) in;

layout(std140, binding = kQuadtreeUniformsBinding) uniform ViewBlock { QuadtreeUniforms view; };
layout(std430, binding = kQuadtreeBlocksBinding) readonly buffer BlockBlock { QuadtreeBlock quadtree_blocks[]; };
layout(std430, binding = kQuadtreePlacesBinding) readonly buffer PlaceBlock { QuadtreePlace quadtree_places[]; };
layout(std430, binding = kQuadtreeCellsBinding) coherent buffer CellBlock { QuadtreeCell quadtree_cells[]; };
layout(std430, binding = kQuadtreeCommandsBinding) buffer CommandBlock { QuadtreeCommands commands; };

// As quadtree_balance.h asks for it.
bool lower_level(int entry, int level) { return atomicMin(quadtree_cells[entry].level, level) > level; }
#include "../lib/quadtree_balance.h"

layout(location = 0) uniform int pass;

void main() {
    bool changed = balance_entry(view, int(gl_WorkGroupID.x), entry_place(int(gl_LocalInvocationIndex)));
    if (changed) commands.groups[3 * (pass + 1)] = gl_NumWorkGroups.x;
}
