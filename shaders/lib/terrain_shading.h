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
    float height_m;   // likewise, over the sea; finer than the drawn triangles' where heights are sampled
    float sunlit;     // the share of the sun's light that no shadow takes
    // Ground noise, fine and broad: value, slope eastwards, slope northwards, as the texture has them.
    vec3 fine;
    vec3 broad;
};

// Of a place drawn so many metres over the eye.
SHADER_FUNCTION float true_height_m(FrameUniforms frame, float over_eye_m) {
    return frame.sun_direction.w + over_eye_m * frame.scale.w;
}

// What 8 bits make of the slope of level noise.
SHADER_CONSTANT float kLevelSlope = 128.0f / 255.0f;

// The normal with bumps too small for the data. Far away the noise averages out, and they with it.
SHADER_FUNCTION vec3 bumped_normal(vec3 normal, vec3 fine, vec3 broad) {
    float east = 0.55f * (fine.y - kLevelSlope) + 0.50f * (broad.y - kLevelSlope);
    float north = 0.55f * (fine.z - kLevelSlope) + 0.50f * (broad.z - kLevelSlope);
    return normalize(vec3(normal.x - east, normal.y - north, normal.z));
}

// What a ground of this linear reflectance and true normal sends through the air.
SHADER_FUNCTION vec3 lit_ground(FrameUniforms frame, GroundPoint point, vec3 color, vec3 normal) {
    vec3 sun = vec3(frame.sun_direction);
    vec3 light = illumination(exaggerate_normal(normal, frame.scale.w), sun, vec3(frame.sun_light),
                              vec3(frame.sky_light), point.sunlit);
    float distance_m = length(point.position_m);
    vec3 through = transmittance(distance_m, point.position_m.z, frame.sun_direction.w, frame.noise_scale.z);
    vec3 air = sky_radiance(point.position_m / distance_m, sun);
    return mix(air, color * light, through);
}

// Where no imagery covers it.
SHADER_FUNCTION vec3 tinted_ground(FrameUniforms frame, GroundPoint point) {
    return ground_color(point.height_m, point.normal.z, vec2(point.fine.x, point.broad.x),
                        vec3(frame.tint_range_m));
}

SHADER_FUNCTION vec3 ground_radiance(FrameUniforms frame, GroundPoint point) {
    vec3 normal = bumped_normal(point.normal, point.fine, point.broad);
    return lit_ground(frame, point, tinted_ground(frame, point), normal);
}

// Pictures show ground as bright as a display makes it in full sun. Of this reflectance, level ground under
// the usual sun comes out of the tone curve as bright as in the picture.
SHADER_CONSTANT float kPictureReflectance = 0.5f;

// How much of the ground's own unevenness a picture lacks that is shown larger than it is: coarseness is the
// binary logarithm of its texels a pixel. All of it from four pixels a texel on.
SHADER_FUNCTION float lacking_structure(FrameUniforms frame, float coarseness) {
    return frame.noise_scale.w * clamp(-0.5f * coarseness, 0.0f, 1.0f);
}

SHADER_FUNCTION vec3 structured_picture(GroundPoint point, vec3 picture, float structure) {
    float uneven = 0.35f * point.fine.x + 0.65f * point.broad.x - 0.5f;
    return picture * (kPictureReflectance * (1.0f + 0.5f * structure * uneven));
}

// Where it covers the ground wholly.
SHADER_FUNCTION vec3 wholly_pictured_radiance(FrameUniforms frame, GroundPoint point, vec4 picture,
                                              float structure) {
    vec3 normal = mix(point.normal, bumped_normal(point.normal, point.fine, point.broad), structure);
    return lit_ground(frame, point, structured_picture(point, vec3(picture), structure), normal);
}

// picture: linear colours times coverage, coverage. The less of it, the more tint, and bumps that the picture
// has of its own.
SHADER_FUNCTION vec3 pictured_radiance(FrameUniforms frame, GroundPoint point, vec4 picture,
                                       float structure) {
    float tint = 1.0f - picture.w;
    vec3 color = structured_picture(point, vec3(picture), structure) + tinted_ground(frame, point) * tint;
    vec3 bumped = bumped_normal(point.normal, point.fine, point.broad);
    return lit_ground(frame, point, color, mix(point.normal, bumped, max(tint, structure)));
}

SHADER_END
