// How high the bumps of one octave of synthesised ground are: docs/detail.md.
#pragma once

#include "portable.h"

SHADER_BEGIN

// A gain of 1 in fixed point.
SHADER_CONSTANT int kDetailGainOne = 4096;
// No gain is larger: products stay within 32 bits.
SHADER_CONSTANT int kMostDetailGain = 8191;

// Invocations of a work group of passes/detail.comp, and the image unit of the tiles that it makes.
SHADER_CONSTANT int kDetailGroup = 64;
SHADER_CONSTANT int kMadeTilesImage = 0;

struct DetailOctave {
    // What slope and roughness are worth to a sample in the middle of four, and between two. In kDetailGainOne.
    int face_slope, face_roughness, edge_slope, edge_roughness;
};
SHADER_STRUCT_SIZE(DetailOctave, 16)

SHADER_END
