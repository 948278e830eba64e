// The quadtree surface's data on the GPU: blocks of ground, what their cells are like, which of them are
// drawn. docs/quadtree.md explains it.
#pragma once

#include "portable.h"

SHADER_BEGIN

// Cells of a block's side, at its finest.
SHADER_CONSTANT int kQuadtreeSide = 8;
SHADER_CONSTANT int kQuadtreeEntries = 64;
// How often a block can divide: its cells are of four levels.
SHADER_CONSTANT int kQuadtreeDepth = 3;
// A cell's coarseness in fixed point: so many steps from a level to the next.
SHADER_CONSTANT int kLodSteps = 64;
// A border's lods are packed in so many bits each, from their cell's level on: nearly sixteen levels, where chunks, which
// have the source's samples, may lie beside cells eight octaves finer.
SHADER_CONSTANT int kBorderBits = 10;

// Where cells draw all ground, they may be as coarse as they like.
SHADER_CONSTANT int kQuadtreeAnyLevel = 31;
// 32 borders' places a word: of a node's side, at the source's finest level, as many as the largest tile takes.
SHADER_CONSTANT int kSeamWords = 8;

SHADER_CONSTANT int kQuadtreeUniformsBinding = 4;
// Storage blocks; 3 and 4 are imagery's and heights' fades.
SHADER_CONSTANT int kQuadtreeBlocksBinding = 0;
SHADER_CONSTANT int kQuadtreePlacesBinding = 1;
SHADER_CONSTANT int kQuadtreeShapesBinding = 2;
SHADER_CONSTANT int kQuadtreeInstancesBinding = 5;
SHADER_CONSTANT int kQuadtreeCellsBinding = 6;
SHADER_CONSTANT int kQuadtreeCommandsBinding = 7;
// While cells are drawn; the passes have places there.
SHADER_CONSTANT int kQuadtreeSeamsBinding = 1;

struct QuadtreeUniforms {
    // The eye's cell (select::EyeFrame); its quanta; log2 of the quads of a cell's side.
    ivec4 eye_cell;
    // log2 of the places; the coarsest blocks' coarseness; how many of the finest levels are made below the source; the
    // coarsest level that is drawn: where chunks draw the rest, the source's finest, else kQuadtreeAnyLevel.
    ivec4 blocks;
    // What the eye is past its cell, in samples, and past its quanta; metres a sixteenth of a quantum.
    vec4 eye_rest;
    // Metres a sample eastwards and southwards; then the distance within which a cell splits: by metre of its
    // error, and by metre of its samples' spacing.
    vec4 scale;
    // How low and how high anything drawn may reach, metres over the eye; then metres a unit of made tiles' heights; w
    // unused.
    vec4 reach;
    // Of what the picture may show: ax + by + cz + d, metres east, north and up of the eye; outside where
    // negative.
    vec4 planes[6];
};
SHADER_STRUCT_SIZE(QuadtreeUniforms, 176)

// Ground that is drawn with a tile's spacing: those of a node's quarters that are no blocks of their own.
struct QuadtreeBlock {
    ivec2 node;  // column and row at its level
    int coarseness;
    // The tile's slot; then whether chunks draw the ground, not cells; whether the tile is the node's own, or that of
    // the nearest ancestor that has one; the quarters: 26 bits, 1, 1 and 4.
    uint slot_and_quarters;
    // The block of the nearest ancestor that has a tile of its own, -1 without one; and how much the tile still looks like
    // that one's: from 1, all, to 0. Without a tile of its own all.
    int above;
    float fade;
    uint unused_[2];
};
SHADER_STRUCT_SIZE(QuadtreeBlock, 32)

// Where a block lies: its node, and its number and one, nothing being there otherwise. Open addressing.
struct QuadtreePlace {
    uint node;  // column, row << 16
    uint block_and_coarseness;
};

// What the cells of a tile are like, by depth (1, 4, 16 of them, row by row): the largest error of drawing
// them in eight by eight quads, in sixteenths of a quantum or a made tile's units; and the tile's least and largest height.
SHADER_CONSTANT int kShapeErrors = 21;
struct QuadtreeShape {
    int error[21];
    int least, most;
    int unused_;
};
SHADER_STRUCT_SIZE(QuadtreeShape, 96)

// An entry: the level of its cell, and how coarse that is in kLodSteps.
struct QuadtreeCell {
    int level;
    int lod;
};

// What the passes tell the GPU to do: the draw, as glDrawElementsIndirect reads it, and for each pass of
// balancing its work groups, as glDispatchComputeIndirect does: none where the pass before changed nothing.
SHADER_CONSTANT int kMostBalancePasses = 48;
struct QuadtreeCommands {
    uint index_count, cells, first_index, first_vertex, first_cell;
    uint left_out;  // cells for which there was no room
    uint unused_[2];
    uint groups[147];
    uint unused_at_end_;
};
SHADER_STRUCT_SIZE(QuadtreeCommands, 624)

// A drawn cell: its north-western sample, its level, and how coarse it and the cells about it are. lod: in its upper
// half, where the cell lies on a border that chunks may draw beyond, the number and one of the block that has it.
struct QuadtreeInstance {
    ivec2 corner;
    int level;
    uint lod;
    // How coarse it is about its border, in kLodSteps from its own level, at least its own lod: of each side, clockwise from
    // the northern one, the corner where it begins, then its halves, in kBorderBits each.
    uint border[4];
};
SHADER_STRUCT_SIZE(QuadtreeInstance, 32)

SHADER_END
