// The uniform block of the disc: its rings, and where cached heights lie. Written once a frame by
// terrain/render/height_texture.cpp; docs/disc.md explains it.
#pragma once

#include "portable.h"

SHADER_BEGIN

SHADER_CONSTANT int kDiscUniformsBinding = 3;
SHADER_CONSTANT int kHeightFadesBinding = 4;
SHADER_CONSTANT int kHeightTableUnit = 5;
SHADER_CONSTANT int kHeightTilesUnit = 6;
// As io/heights_tile.h has it: samples beyond a tile's own on every side.
SHADER_CONSTANT int kHeightApron = 3;

// Radius of a ring in its own spacings. A ring's triangles are seen under 1/96 to 1/48 of a radian.
SHADER_CONSTANT int kDiscRadius = 96;
// Between these distances from the eye, in spacings, a ring's surface turns into the next ring's. The end
// lies inside the ring wherever in its lattice's cell the eye stands (radius, less a cell of four spacings
// and half a cell, both along the diagonal); the start lies outside the ring within, seen from as high as
// that ring is drawn at all: half of sqrt((96 + 3)^2 + 87^2).
SHADER_CONSTANT float kDiscMorphStart = 67.0f;
SHADER_CONSTANT float kDiscMorphEnd = 87.0f;

struct DiscUniforms {
    // The eye's cell (select::EyeFrame), then the lattice's columns and rows of samples.
    ivec4 eye_cell_and_size;
    // The finest level; log2 of the columns and of the rows of a page table's level; log2 of a tile's cells.
    ivec4 table;
    // What the eye is past its cell, columns and rows; then finest samples that a pixel covers at a metre's
    // distance; then a made tile's unit of height, in quanta.
    vec4 eye;
    // About which rings lie, in finest samples: a place in the eye's cell, columns and rows past its corner,
    // and how far the eye is from it; w unused. Over the terrain the eye's own place and its height over the
    // ground.
    vec4 middle;
    // How many of the finest levels are made below the source, and log2 of their heights' units to a quantum
    // (detail_texels.h); z and w unused.
    ivec4 detail;
};

SHADER_STRUCT_SIZE(DiscUniforms, 80)
SHADER_OFFSET(DiscUniforms, eye, 32)
SHADER_OFFSET(DiscUniforms, middle, 48)
SHADER_OFFSET(DiscUniforms, detail, 64)

SHADER_END
