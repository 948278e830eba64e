// The uniform block of a frame: camera, light, tint. Written once a frame by terrain/render/frame.cpp.
//
// Lengths are metres in world axes (x east, y north, z up) relative to the eye, unless they are said to be
// lattice units (finest samples, y southwards). All members are four components wide, so that std140 and C++
// agree.
#pragma once

#include "portable.h"

SHADER_BEGIN

SHADER_CONSTANT int kFrameUniformsBinding = 0;

struct FrameUniforms {
    mat4 clip_from_eye;
    // The world direction through window position (x, y), of unit depth: origin + x * dx + y * dy.
    vec4 ray_origin;
    vec4 ray_dx;
    vec4 ray_dy;
    // Metres: column spacing, row spacing, drawn height of a quantum; then the inverse of the exaggeration.
    vec4 scale;
    // What the eye is past its cell: columns, rows, quanta (select::EyeFrame).
    vec4 eye_rest;
    // The quanta of the eye's cell in x; its column and row are in the instances' origins. In y the octaves by which the
    // lattice is finer than chunks' samples; the rest unused.
    ivec4 eye_cell;
    // Towards the sun; w: the eye's true height in metres (without exaggeration).
    vec4 sun_direction;
    // Light of the sun and of the whole sky on a horizontal plane; w unused.
    vec4 sun_light;
    vec4 sky_light;
    // Where the tint's zones lie, metres: lowest and highest height, highest water; w unused.
    vec4 tint_range_m;
    // Offsets of the ground noise, in repeats: fine octave x, y, broad octave x, y.
    vec4 noise_offset;
    // Repeats of the ground noise per metre: fine, broad. Then how much haze: 0 off, 1 clear air. Then how
    // much of the noise pictures get that are shown larger than they are.
    vec4 noise_scale;
    // The colour that stands for the sky, 0..255 each; w: 1 where it does, 0 where the sky is drawn.
    vec4 background;
};

SHADER_STRUCT_SIZE(FrameUniforms, 272)
SHADER_OFFSET(FrameUniforms, ray_origin, 64)
SHADER_OFFSET(FrameUniforms, eye_cell, 144)
SHADER_OFFSET(FrameUniforms, background, 256)

#ifndef __cplusplus
layout(std140, binding = kFrameUniformsBinding) uniform FrameBlock { FrameUniforms frame; };
#endif

SHADER_END
