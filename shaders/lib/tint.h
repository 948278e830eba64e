// The ground's colour where no imagery covers it: zones by height as one finds them climbing a mountain, rock
// where it is steep, water where it is level with the sea. Linear reflectances, kept within what soil and
// plants have.
#pragma once

#include "../shared/portable.h"

SHADER_BEGIN

// 0 below `from`, 1 above `to`, straight between; from < to.
SHADER_FUNCTION float ramp(float from, float to, float x) {
    return clamp((x - from) / (to - from), 0.0f, 1.0f);
}

// Zones at shares of the range: green lowland, drier foothills, forest, alpine grass, bare rock, snow.
SHADER_FUNCTION vec3 zone_color(float share) {
    vec3 color = vec3(0.100f, 0.126f, 0.050f);
    color = mix(color, vec3(0.165f, 0.150f, 0.082f), ramp(0.03f, 0.11f, share));
    color = mix(color, vec3(0.058f, 0.082f, 0.036f), ramp(0.13f, 0.28f, share));
    color = mix(color, vec3(0.043f, 0.062f, 0.034f), ramp(0.38f, 0.55f, share));
    color = mix(color, vec3(0.128f, 0.124f, 0.072f), ramp(0.60f, 0.72f, share));
    return mix(color, vec3(0.175f, 0.162f, 0.145f), ramp(0.74f, 0.85f, share));
}

// Rock shows through where soil slides off: from about 40 degrees on, and everywhere by 60.
SHADER_FUNCTION float rock_share(float normal_up, float noise) {
    return 1.0f - ramp(0.50f, 0.76f, normal_up + 0.16f * (noise - 0.5f));
}

// Snow lies above the highest zone, but not on what is steep.
SHADER_FUNCTION float snow_share(float share, float normal_up, float noise) {
    float high = ramp(0.86f, 0.93f, share + 0.10f * (noise - 0.5f));
    return high * ramp(0.60f, 0.76f, normal_up);
}

// Level ground no higher than the sea.
SHADER_FUNCTION float water_share(float height_m, float water_m, float normal_up) {
    float low = 1.0f - ramp(water_m, water_m + 0.4f, height_m);
    return low * ramp(0.99990f, 0.99998f, normal_up);
}

// height_m: true height; normal_up: the true normal's z; noise: fine and broad, each 0..1; range_m as
// FrameUniforms.tint_range_m.
SHADER_FUNCTION vec3 ground_color(float height_m, float normal_up, vec2 noise, vec3 range_m) {
    float share = (height_m - range_m.x) / (range_m.y - range_m.x);
    float uneven = 0.35f * noise.x + 0.65f * noise.y;
    vec3 color = zone_color(share + 0.14f * (uneven - 0.5f));
    vec3 rock = mix(vec3(0.120f, 0.108f, 0.090f), vec3(0.190f, 0.180f, 0.168f), clamp(share, 0.0f, 1.0f));
    color = mix(color, rock, rock_share(normal_up, uneven));
    color = color * (0.74f + 0.52f * uneven);
    color = mix(color, vec3(0.60f, 0.64f, 0.70f), snow_share(share, normal_up, uneven));
    return mix(color, vec3(0.020f, 0.050f, 0.070f), water_share(height_m, range_m.z, normal_up));
}

SHADER_END
