#version 450 core
// What the cells of a tile of heights are like, once it has come: a work group a tile, an invocation an
// entry.
#include "../shared/disc_uniforms.h"
#include "../shared/quadtree_blocks.h"

layout(local_size_x = kQuadtreeEntries) in;

layout(binding = kHeightTilesUnit) uniform isampler2DArray height_tiles;
layout(std430, binding = kQuadtreeShapesBinding) buffer ShapeBlock { QuadtreeShape quadtree_shapes[]; };
#include "../lib/quadtree_shape.h"

layout(location = 0) uniform ivec3 slot_quads_level;
layout(location = 1) uniform ivec2 unfiltered_and_shift;

shared QuadtreeShape shape;

void main() {
    int entry = int(gl_LocalInvocationIndex);
    int slot = slot_quads_level.x;
    if (entry < kShapeErrors) shape.error[entry] = 0;
    if (entry == 0) {
        shape.least = 0x7fffffff;
        shape.most = -0x7fffffff;
    }
    barrier();
    ShapeTile tile = ShapeTile(slot_quads_level.y, slot_quads_level.z, unfiltered_and_shift.x, unfiltered_and_shift.y);
    EntryShape part = entry_shape(slot, tile, entry_place(entry));
    for (int depth = 0; depth < kQuadtreeDepth; ++depth)
        atomicMax(shape.error[shape_index(entry_place(entry), depth)], part.error[depth]);
    atomicMin(shape.least, part.least);
    atomicMax(shape.most, part.most);
    barrier();
    if (entry == 0) quadtree_shapes[slot] = shape;
}
