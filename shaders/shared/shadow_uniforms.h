// The uniform block of the sun's shadow maps: how to look a place up in each of them. Written once a frame by
// terrain/render/shadow_maps.cpp, which docs/shadows.md explains.
#pragma once

#include "portable.h"

SHADER_BEGIN

SHADER_CONSTANT int kShadowUniformsBinding = 1;
SHADER_CONSTANT int kShadowMapUnit = 2;
// Rings about the eye, each with a map of its own.
SHADER_CONSTANT int kShadowCascades = 5;

struct ShadowCascade {
    // From metres relative to the eye: x, y in -1..1 over the map, z from 0 to 1 towards the sun.
    mat4 map_from_eye;
    // Distances from the eye, metres: where the next cascade begins to take over, where it has. Then the
    // metres that a texel covers across the sun's azimuth and along it.
    vec4 reach_and_texel;
};

struct ShadowUniforms {
    ShadowCascade cascades[kShadowCascades];
    // Directions of the maps' x and y; w unused.
    vec4 across;
    vec4 along;
    // Texels of a map's side, its inverse, then what is added to a depth for its rounding; w unused.
    vec4 map;
};

SHADER_STRUCT_SIZE(ShadowCascade, 80)
SHADER_STRUCT_SIZE(ShadowUniforms, 448)
SHADER_OFFSET(ShadowUniforms, across, 400)

#ifndef __cplusplus
layout(std140, binding = kShadowUniformsBinding) uniform ShadowBlock { ShadowUniforms shadows; };
#endif

SHADER_END
