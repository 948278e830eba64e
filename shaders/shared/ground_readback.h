// What the pass that reads the ground back leaves behind: the borders of what is seen, and a mask of it.
// terrain/render/ground_readback.cpp fetches it some frames later.
#pragma once

#include "portable.h"

SHADER_BEGIN

SHADER_CONSTANT int kGroundResultBinding = 7;
SHADER_CONSTANT int kGroundDepthUnit = 7;

// Nested grids of cells about the eye (select::GroundMask): their number, cells of a side, words of 32 cells
// in all.
SHADER_CONSTANT int kGroundGrids = 12;
SHADER_CONSTANT int kGroundSide = 64;
SHADER_CONSTANT int kGroundWords = 1536;

// Samples of the picture that a work group looks at, along each side.
SHADER_CONSTANT int kGroundGroup = 16;

struct GroundResult {
    // Of west, south, east, north: how far the ground reaches from the eye, metres, as ordered bits; zero
    // where there is none.
    uint reach[4];
    // Grid by grid, row by row from the south, two words a row, the westernmost cell in the lowest bit.
    uint cells[kGroundWords];
};

SHADER_STRUCT_SIZE(GroundResult, 6160)

SHADER_END
