#version 450 core
// The levels, and lods, that distance and error ask for: a work group a block, an invocation an entry.
#include "../shared/quadtree_blocks.h"

layout(local_size_x = kQuadtreeEntries) in;

layout(std140, binding = kQuadtreeUniformsBinding) uniform ViewBlock { QuadtreeUniforms view; };
layout(std430, binding = kQuadtreeBlocksBinding) readonly buffer BlockBlock { QuadtreeBlock quadtree_blocks[]; };
layout(std430, binding = kQuadtreePlacesBinding) readonly buffer PlaceBlock { QuadtreePlace quadtree_places[]; };
layout(std430, binding = kQuadtreeShapesBinding) readonly buffer ShapeBlock { QuadtreeShape quadtree_shapes[]; };
layout(std430, binding = kQuadtreeCellsBinding) buffer CellBlock { QuadtreeCell quadtree_cells[]; };

// By shape_index, and by entry: of one block after another.
shared int least_lods[kShapeErrors];
shared int lods[kQuadtreeEntries];
#include "../lib/quadtree_levels.h"

// By all of the group together. lods: of the block above, where this one is like it; then of this one.
AskedCell ask(QuadtreeBlock block, ivec2 place) {
    int share = like_above(block), entry = entry_at(place);
    int own = share < kTurnSteps ? own_lod(view, block, place) : 0;
    int above =
        share > 0 ? lods[entry_at(place_above(block, place, quadtree_blocks[block.above].coarseness))] : 0;
    int wanted = wanted_lod(block, own, above);
    if (entry < kShapeErrors) least_lods[entry] = (kQuadtreeAnyLevel + 1) * kLodSteps;
    barrier();
    for (int depth = 0; depth < kQuadtreeDepth; ++depth)
        atomicMin(least_lods[shape_index(place, depth)], wanted);
    barrier();
    AskedCell cell = asked_cell(block, place, wanted);
    lods[entry] = cell.lod;
    barrier();
    return cell;
}

// After all of those above that the block is still like, from the coarsest on.
AskedCell ask_from_above(int number, ivec2 place) {
    int chain[kQuadtreeAnyLevel + 1];
    int last = 0;
    chain[0] = number;
    for (QuadtreeBlock block = quadtree_blocks[number]; like_above(block) > 0;) {
        ++last;
        chain[last] = block.above;
        block = quadtree_blocks[block.above];
    }
    AskedCell cell;
    for (int i = last; i >= 0; --i) cell = ask(quadtree_blocks[chain[i]], place);
    return cell;
}

void main() {
    QuadtreeBlock block = quadtree_blocks[gl_WorkGroupID.x];
    ivec2 place = entry_place(int(gl_LocalInvocationIndex));
    AskedCell cell = ask_from_above(int(gl_WorkGroupID.x), place);
    int level = has_entry(block, place) ? asked_level(view, block, cell) : 0;
    quadtree_cells[gl_GlobalInvocationID.x] = QuadtreeCell(level, cell.lod);
}
