// The sRGB transfer functions (IEC 61966-2-1), for 8-bit pictures: shading and averaging are done in linear
// light.
#pragma once
#include "../shared/portable.h"

SHADER_BEGIN

// Both for values in [0, 1].
SHADER_FUNCTION float linear_from_srgb(float srgb) {
    return srgb <= 0.04045f ? srgb / 12.92f : pow((srgb + 0.055f) / 1.055f, 2.4f);
}

SHADER_FUNCTION float srgb_from_linear(float linear) {
    return linear <= 0.0031308f ? linear * 12.92f : 1.055f * pow(linear, 1.0f / 2.4f) - 0.055f;
}

SHADER_FUNCTION vec3 linear_from_srgb(vec3 srgb) {
    return vec3(linear_from_srgb(srgb.x), linear_from_srgb(srgb.y), linear_from_srgb(srgb.z));
}

SHADER_FUNCTION vec3 srgb_from_linear(vec3 linear) {
    return vec3(srgb_from_linear(linear.x), srgb_from_linear(linear.y), srgb_from_linear(linear.z));
}

// Relative luminance of linear light (Rec. 709 primaries).
SHADER_FUNCTION float luminance(vec3 linear) {
    return 0.2126f * linear.x + 0.7152f * linear.y + 0.0722f * linear.z;
}

SHADER_END
