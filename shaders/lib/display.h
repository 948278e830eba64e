// From linear light to the eight bits of a screen: exposure, tone curve, sRGB, dithering.
#pragma once

#include "../shared/portable.h"
#include "color.h"

SHADER_BEGIN

// A filmic curve: K. Narkowicz, "ACES Filmic Tone Mapping Curve" (2015), the rational fit.
SHADER_FUNCTION vec3 tone_map(vec3 radiance) {
    vec3 x = radiance * 0.72f;
    vec3 mapped = (x * (x * 2.51f + 0.03f)) / (x * (x * 2.43f + 0.59f) + 0.14f);
    return clamp(mapped, vec3(0.0f), vec3(1.0f));
}

// Ordered noise in [0, 1) without pattern or state: J. Jimenez, "Next Generation Post Processing in Call of
// Duty" (2014), interleaved gradient noise. The same pixel always gets the same.
SHADER_FUNCTION float dither(vec2 pixel) {
    return fract(52.9829189f * fract(0.06711056f * pixel.x + 0.00583715f * pixel.y));
}

// Whole steps 0..255, rounded up or down at random so that gradients do not band.
SHADER_FUNCTION vec3 quantize(vec3 srgb, float noise) {
    return floor(clamp(srgb, vec3(0.0f), vec3(1.0f)) * 255.0f + noise);
}

// One step away from the colour that stands for the sky, where it is hit exactly.
SHADER_FUNCTION vec3 avoid_background(vec3 steps, vec4 background) {
    bool same = steps.x == background.x && steps.y == background.y && steps.z == background.z;
    float nudge = background.y < 128.0f ? 1.0f : -1.0f;
    return (same && background.w > 0.5f) ? vec3(steps.x, steps.y + nudge, steps.z) : steps;
}

// What is written into an RGBA8 target.
SHADER_FUNCTION vec4 display_color(vec3 radiance, vec2 pixel, vec4 background) {
    vec3 steps = quantize(srgb_from_linear(tone_map(radiance)), dither(pixel));
    vec3 kept = avoid_background(min(steps, vec3(255.0f)), background);
    return vec4(kept.x / 255.0f, kept.y / 255.0f, kept.z / 255.0f, 1.0f);
}

SHADER_END
