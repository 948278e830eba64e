// From a place on the ground to its bit in a mask of nested grids (select::GroundMask).
#pragma once
#include "../shared/ground_readback.h"
#include "../shared/portable.h"

SHADER_BEGIN

// Where a mask's cells lie: from the eye to the south-western corner of the centre's cell (negative), cells
// per metre, the cell of the eye, and how many cells there are.
struct GroundCells {
    vec2 corner_m;
    float cells_per_m;
    ivec2 centre;
    ivec2 count;
};

SHADER_FUNCTION ivec2 ground_cell(vec2 from_eye_m, GroundCells cells) {
    ivec2 from_centre = ivec2(floor((from_eye_m - cells.corner_m) * cells.cells_per_m));
    return clamp(cells.centre + from_centre, ivec2(0), cells.count - ivec2(1));
}

// A cell's column and row in a grid.
SHADER_FUNCTION ivec2 cell_in_grid(ivec2 cell, ivec2 centre, int grid) {
    return ivec2((cell.x >> grid) - (centre.x >> grid) + kGroundSide / 2,
                 (cell.y >> grid) - (centre.y >> grid) + kGroundSide / 2);
}

SHADER_FUNCTION bool is_in_grid(ivec2 place) {
    return place.x >= 0 && place.y >= 0 && place.x < kGroundSide && place.y < kGroundSide;
}

// The innermost grid that holds a cell; the outermost holds all.
SHADER_FUNCTION int innermost_grid(ivec2 cell, ivec2 centre) {
    int grid = 0;
    while (grid < kGroundGrids - 1 && !is_in_grid(cell_in_grid(cell, centre, grid))) ++grid;
    return grid;
}

SHADER_FUNCTION int ground_word(ivec2 place, int grid) {
    return (grid * kGroundSide + place.y) * 2 + (place.x >> 5);
}

SHADER_FUNCTION uint ground_bit(ivec2 place) { return uint(1) << uint(place.x & 31); }

// Unsigned numbers in the order of floats, and never 0 but for what is not a number.
SHADER_FUNCTION uint ordered_bits(float value) {
    uint bits = floatBitsToUint(value);
    return (bits >> 31u) != 0u ? ~bits : bits | 0x80000000u;
}

SHADER_FUNCTION float from_ordered_bits(uint bits) {
    return uintBitsToFloat((bits >> 31u) != 0u ? bits & 0x7fffffffu : ~bits);
}

SHADER_END
