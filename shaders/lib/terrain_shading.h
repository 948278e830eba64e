// The light that comes from a point of the ground to the eye.
#pragma once

#include "../shared/frame_uniforms.h"
#include "../shared/portable.h"
#include "atmosphere.h"
#include "normals.h"
#include "tint.h"

SHADER_BEGIN

struct GroundPoint {
    vec3 position_m;  // from the eye, with exaggeration
    vec3 normal;      // true, without exaggeration
    vec2 noise;       // fine and broad, 0..1
};

SHADER_FUNCTION vec3 ground_radiance(FrameUniforms frame, GroundPoint point) {
    float inverse_exaggeration = frame.scale.w;
    float height_m = frame.sun_direction.w + point.position_m.z * inverse_exaggeration;
    vec3 sun = vec3(frame.sun_direction);
    vec3 color = ground_color(height_m, point.normal.z, point.noise, vec3(frame.tint_range_m));
    vec3 light = illumination(exaggerate_normal(point.normal, inverse_exaggeration), sun,
                              vec3(frame.sun_light), vec3(frame.sky_light));
    float distance_m = length(point.position_m);
    vec3 through = transmittance(distance_m, point.position_m.z, frame.sun_direction.w, frame.noise_scale.z);
    vec3 air = sky_radiance(point.position_m / distance_m, sun);
    return mix(air, color * light, through);
}

SHADER_END
