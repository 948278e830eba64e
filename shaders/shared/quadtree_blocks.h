// The quadtree surface's data on the GPU: blocks of ground, what their cells are like, which of them are drawn.
// docs/quadtree.md explains it.
#pragma once

#include "portable.h"

SHADER_BEGIN

// Cells of a block's side, at its finest; and quads of a drawn cell's.
SHADER_CONSTANT int kQuadtreeSide = 8;
SHADER_CONSTANT int kQuadtreeEntries = 64;
// How often a block can divide: its cells are of four levels.
SHADER_CONSTANT int kQuadtreeDepth = 3;
// A cell's coarseness in fixed point: 256 steps from a level to the next.
SHADER_CONSTANT int kLodSteps = 256;

// Storage blocks.
SHADER_CONSTANT int kQuadtreeUniformsBinding = 5;
SHADER_CONSTANT int kQuadtreeBlocksBinding = 5;
SHADER_CONSTANT int kQuadtreePlacesBinding = 6;
SHADER_CONSTANT int kQuadtreeShapesBinding = 7;
SHADER_CONSTANT int kQuadtreeLevelsBinding = 8;
SHADER_CONSTANT int kQuadtreeLodsBinding = 9;
SHADER_CONSTANT int kQuadtreeInstancesBinding = 10;
SHADER_CONSTANT int kQuadtreeCommandsBinding = 11;

struct QuadtreeUniforms {
    // The eye's cell (select::EyeFrame); its quanta; how many blocks there are.
    ivec4 eye_cell;
    // The lattice's columns and rows of samples; log2 of the places; the coarseness of the coarsest blocks.
    ivec4 ground;
    // What the eye is past its cell, in samples, and past its quanta; metres a sixteenth of a quantum.
    vec4 eye_rest;
    // Metres a sample eastwards and southwards; then the distance within which a cell splits: by metre of its error,
    // and by metre of its samples' spacing.
    vec4 scale;
    // In the drawn frame, of the view: ax + by + cz + d, metres from the eye; outside where negative.
    vec4 planes[6];
};
SHADER_STRUCT_SIZE(QuadtreeUniforms, 160)

// Ground that is drawn from one tile of heights: those of its quarters of which there is no finer tile.
struct QuadtreeBlock {
    ivec2 node;     // column and row at the tile's level
    int coarseness;  // of the tile
    uint slot_and_quarters;  // 28 bits and 4
};
SHADER_STRUCT_SIZE(QuadtreeBlock, 16)

// Where a block lies: its node, and its number and one, nothing being there otherwise. Open addressing.
struct QuadtreePlace {
    uint node;  // column, row << 16
    uint block_and_coarseness;
};

// What the cells of a tile are like, by depth (1, 4, 16 of them, row by row): the largest error of drawing them in eight
// by eight quads, in sixteenths of a quantum; and the tile's least and largest height.
SHADER_CONSTANT int kShapeErrors = 21;
struct QuadtreeShape {
    int error[21];
    int least, most;
    int unused_;
};
SHADER_STRUCT_SIZE(QuadtreeShape, 96)

// A drawn cell: its north-western sample, its level, and how coarse it and the cells about it are.
struct QuadtreeInstance {
    ivec2 corner;
    int level;
    uint lod;
    // Of the neighbours, in halves: west and north, east and south, then the corners NW and NE, SW and SE. At least its own.
    uint sides[2];
    uint corners[2];
};
SHADER_STRUCT_SIZE(QuadtreeInstance, 32)

SHADER_END
