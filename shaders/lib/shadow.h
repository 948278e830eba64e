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

// How far neighbouring triangles may rise over a triangle's plane within the filter's reach, in texels: where
// they meet in a hollow, it would be a dark line otherwise.
SHADER_CONSTANT float kShadowCreaseTexels = 0.5f;

// How far a place is moved along its unit normal so that its own surface, seen by the sun as texels, stays
// below it: the slope's rise over the filter's reach, seen along the normal, and what creases add. tilt: the
// normal's components across and along.
SHADER_FUNCTION float normal_offset_m(vec2 tilt, vec2 texel_m) {
    float slope_m = kShadowFilterTexels * (abs(tilt.x) * texel_m.x + abs(tilt.y) * texel_m.y);
    return slope_m + kShadowCreaseTexels * (texel_m.x + texel_m.y);
}

// Where four bilinear comparisons are made, at (x[i], y[j]), and how much the second of x and of y weighs
// against the first.
struct ShadowTaps {
    vec2 x;
    vec2 y;
    vec2 share;
};

// place: x, y in texels from the map's corner, texel i covering [i, i + 1]. Results are texels, too.
SHADER_FUNCTION ShadowTaps shadow_taps(vec2 place) {
    vec2 centre = floor(place + 0.5f);
    vec2 past = place + 0.5f - centre;
    vec2 first = 3.0f - 2.0f * past;
    vec2 second = 1.0f + 2.0f * past;
    vec2 first_at = (2.0f - past) / first - 1.5f + centre;
    vec2 second_at = past / second + 0.5f + centre;
    ShadowTaps taps;
    taps.x = vec2(first_at.x, second_at.x);
    taps.y = vec2(first_at.y, second_at.y);
    taps.share = second * 0.25f;
    return taps;
}

// From a to b by a share, exactly a where they are equal: full light stays full.
SHADER_FUNCTION float blended_light(float a, float b, float share) { return a + (b - a) * share; }

// The share of light from the four comparisons: (x.x, y.x), (x.y, y.x), (x.x, y.y), (x.y, y.y).
SHADER_FUNCTION float sunlit_share(vec4 lit, ShadowTaps taps) {
    return blended_light(blended_light(lit.x, lit.y, taps.share.x), blended_light(lit.z, lit.w, taps.share.x),
                         taps.share.y);
}

SHADER_END
