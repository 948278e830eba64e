#version 450 core
// One pass of bringing neighbours within a level: each entry asks those beside it, and takes what they ask of
// it.
#include "../shared/quadtree_blocks.h"

layout(local_size_x = kQuadtreeEntries) in;

layout(std140, binding = kQuadtreeUniformsBinding) uniform ViewBlock { QuadtreeUniforms view; };
layout(std430, binding = kQuadtreeBlocksBinding) readonly buffer BlockBlock { QuadtreeBlock quadtree_blocks[]; };
layout(std430, binding = kQuadtreePlacesBinding) readonly buffer PlaceBlock { QuadtreePlace quadtree_places[]; };
layout(std430, binding = kQuadtreeCellsBinding) coherent buffer CellBlock { QuadtreeCell quadtree_cells[]; };
layout(std430, binding = kQuadtreeCommandsBinding) buffer CommandBlock { QuadtreeCommands commands; };
#include "../lib/quadtree.h"

layout(location = 0) uniform int pass;

// Levels only sink, so it does not matter who comes first.
bool lower(int entry, int level) { return atomicMin(quadtree_cells[entry].level, level) > level; }

void main() {
    int block = int(gl_WorkGroupID.x), entry = int(gl_LocalInvocationIndex);
    ivec2 place = entry_place(entry);
    if (!has_entry(quadtree_blocks[block], place)) return;
    int level = leaf_level(block, place);
    bool changed = false;
    for (int way = 0; way < 9; ++way) {
        if (way == 4) continue;
        QuadtreeAsk asked = ask_neighbour(view, block, place, level, ivec2(way % 3 - 1, way / 3 - 1));
        level = min(level, asked.own);
        if (asked.entry >= 0) changed = lower(asked.entry, asked.most) || changed;
    }
    changed = lower(block * kQuadtreeEntries + entry, level) || changed;
    if (changed) commands.groups[3 * (pass + 1)] = gl_NumWorkGroups.x;
}
