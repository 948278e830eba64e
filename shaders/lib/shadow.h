// Looking up the sun's shadow maps: which of them, from where, and how their texels are weighed.
//
// Literature: cascades by distance (Engel, "Cascaded Shadow Maps", ShaderX5, 2006); a receiver that is moved
// off its surface along the normal, as far as the filter is wide (Holbert, "Saying Goodbye to Shadow Acne",
// GDC 2011); a tent over 3x3 texels from four bilinear comparisons (Castano, "Shadow Mapping Summary", 2013).
// How we differ: texels are not square, because a low sun sees the ground foreshortened; so the way off the
// surface is measured in the texels that lie in the direction in which the surface is tilted.
#pragma once

#include "../shared/portable.h"

SHADER_BEGIN

// How far the filter reaches from the place that is looked up, in texels.
SHADER_CONSTANT float kShadowFilterTexels = 2.0f;

// The share of the next cascade at a distance from the eye; `reach` as ShadowCascade has it.
SHADER_FUNCTION float next_cascade_share(vec4 reach, float distance_m) {
    return clamp((distance_m - reach.x) / (reach.y - reach.x), 0.0f, 1.0f);
}

// How far a place is moved along its unit normal so that its own surface, seen by the sun as texels, stays
// below it: the slope's rise over the filter's reach, seen along the normal. tilt: the normal's components
// across and along.
SHADER_FUNCTION float normal_offset_m(vec2 tilt, vec2 texel_m) {
    return kShadowFilterTexels * (abs(tilt.x) * texel_m.x + abs(tilt.y) * texel_m.y);
}

// Where four bilinear comparisons are made and what each weighs: at (x[i], y[j]), weight_x[i] * weight_y[j] /
// 16.
struct ShadowTaps {
    vec2 x;
    vec2 y;
    vec2 weight_x;
    vec2 weight_y;
};

// place: x, y in texels from the map's corner, texel i covering [i, i + 1]. Results are texels, too.
SHADER_FUNCTION ShadowTaps shadow_taps(vec2 place) {
    vec2 centre = floor(place + 0.5f);
    vec2 past = place + 0.5f - centre;
    ShadowTaps taps;
    taps.weight_x = vec2(3.0f - 2.0f * past.x, 1.0f + 2.0f * past.x);
    taps.weight_y = vec2(3.0f - 2.0f * past.y, 1.0f + 2.0f * past.y);
    taps.x =
        vec2((2.0f - past.x) / taps.weight_x.x - 1.0f, past.x / taps.weight_x.y + 1.0f) + centre.x - 0.5f;
    taps.y =
        vec2((2.0f - past.y) / taps.weight_y.x - 1.0f, past.y / taps.weight_y.y + 1.0f) + centre.y - 0.5f;
    return taps;
}

// The share of light from the four comparisons: (x.x, y.x), (x.y, y.x), (x.x, y.y), (x.y, y.y).
SHADER_FUNCTION float sunlit_share(vec4 lit, ShadowTaps taps) {
    float upper = lit.x * taps.weight_x.x + lit.y * taps.weight_x.y;
    float lower = lit.z * taps.weight_x.x + lit.w * taps.weight_x.y;
    return (upper * taps.weight_y.x + lower * taps.weight_y.y) / 16.0f;
}

SHADER_END
