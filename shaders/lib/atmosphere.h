// Daylight: the sky's radiance by direction, and what the air between does to the light of the ground.
//
// The sky is a fitted gradient, not a scattering integral: pale at the horizon, deep at the zenith, brighter
// round the sun. The air thins exponentially with height; along a straight ray its optical depth has a closed
// form, and the light it adds is the sky's of the same direction, so ground fades into exactly the sky behind
// it.
#pragma once

#include "../shared/portable.h"

SHADER_BEGIN

// Extinction per metre at sea level, red to blue: clear mountain air, visual range (2 % contrast) of some 130
// km in green, 80 km in blue.
SHADER_CONSTANT vec3 kExtinction = vec3(2.2e-5f, 3.0e-5f, 4.9e-5f);
// Air with its haze thins by e over this height; dust alone would over 1.2 km, air alone over 8.
SHADER_CONSTANT float kHazeHeight_m = 3000.0f;

// How much of the day's light the sky has: all of it from 6 degrees of sun on, a last glimmer through the
// night.
SHADER_FUNCTION float day_share(float sun_sine) {
    float share = clamp((sun_sine + 0.12f) / 0.22f, 0.0f, 1.0f);
    return 0.004f + 0.996f * share * share;
}

// Linear radiance from the unit direction; below the horizon, that of far and hazy ground.
SHADER_FUNCTION vec3 sky_radiance(vec3 direction, vec3 sun) {
    float up = max(direction.z, 0.0f);
    float low = (1.0f - up) * (1.0f - up);
    low = low * low;
    vec3 color = mix(vec3(0.115f, 0.250f, 0.560f), vec3(0.520f, 0.680f, 0.880f), low);
    float towards_sun = max(dot(direction, sun), 0.0f);
    float glow = towards_sun * towards_sun;
    glow = glow * glow;
    color = color + vec3(0.190f, 0.150f, 0.090f) * (glow * (0.35f + 0.65f * low));
    float below = clamp(-direction.z, 0.0f, 1.0f);
    return color * (day_share(sun.z) * (1.0f - 0.45f * below));
}

// The sun's disc and aureole, which only the sky shows; ground haze takes none of it.
SHADER_FUNCTION vec3 sun_disc(vec3 direction, vec3 sun) {
    float cosine = max(dot(direction, sun), 0.0f);
    float aureole = pow(cosine, 350.0f) * 0.9f + pow(cosine, 40.0f) * 0.12f;
    float disc = clamp((cosine - 0.99995f) / 0.00003f, 0.0f, 1.0f) * 12.0f;
    return vec3(1.0f, 0.93f, 0.80f) * ((aureole + disc) * clamp(direction.z * 40.0f + 1.0f, 0.0f, 1.0f));
}

// (1 - exp(-x)) / x, continuous at 0.
SHADER_FUNCTION float exponential_mean(float x) {
    return abs(x) < 1.0e-3f ? 1.0f - 0.5f * x : (1.0f - exp(-x)) / x;
}

// The share of light that comes through the air, from a point `distance_m` away and `rise_m` higher than the
// eye.
SHADER_FUNCTION vec3 transmittance(float distance_m, float rise_m, float eye_height_m, float haze) {
    float density = exp(-max(eye_height_m, 0.0f) / kHazeHeight_m);
    float column_m = distance_m * density * exponential_mean(clamp(rise_m / kHazeHeight_m, -20.0f, 20.0f));
    return exp(kExtinction * (-haze * column_m));
}

// Light reaching a surface: the sun on what faces it, the sky on what faces up, a little from the ground
// around. Shadow takes the sun's own light alone, all but `sunlit` of it.
SHADER_FUNCTION vec3 illumination(vec3 normal, vec3 sun, vec3 sun_light, vec3 sky_light, float sunlit) {
    float facing = max(dot(normal, sun), 0.0f) * sunlit;
    float open = 0.5f + 0.5f * normal.z;
    return sun_light * facing + sky_light * open + (sun_light * sun.z + sky_light) * (0.12f * (1.0f - open));
}

SHADER_END
