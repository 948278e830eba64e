#include "ridgeline/render/frame_uniforms.h"

#include <algorithm>
#include <cmath>

#include "ridgeline/shaders/lib/atmosphere.h"

namespace ridgeline::render {
namespace {

// Lengths over which the ground noise repeats. Fine: a texel is a hand's breadth, what one sees of the ground
// underfoot. Broad: patches of plants, gullies too small for the data; no multiple of the fine one.
constexpr double kFineNoise_m = 29.0;
constexpr double kBroadNoise_m = 911.0;
// Datasets without mountains get no snow: their zones are those of a range at least as high.
constexpr double kLeastZoneRange_m = 1400.0;

// Sunlight reddens and fades as the sun sinks: the air it crosses grows as 1 / sin(elevation).
glm::vec3 sun_light(double sine) {
    const double air = 1.0 / std::max(sine, 0.05);
    const glm::dvec3 through = glm::exp(glm::dvec3(0.055, 0.095, 0.19) * -air);
    return glm::vec3(through * (3.5 * std::clamp(sine / 0.05, 0.0, 1.0)));
}

glm::vec3 sky_light(double sine) {
    const double share = 0.45 + 0.55 * std::clamp(sine / 0.35, 0.0, 1.0);
    return glm::vec3(glm::dvec3(0.40, 0.51, 0.70) * share) * shaders::day_share(static_cast<float>(sine));
}

// The world direction through a window position is origin + x * dx + y * dy.
void set_rays(const platform::Camera& camera, shaders::FrameUniforms& frame) {
    const glm::dvec2 tangents = platform::half_tangents(camera.lens);
    const glm::dvec3 right = platform::right(camera.pose) * tangents.x;
    const glm::dvec3 up = platform::up(camera.pose) * tangents.y;
    const glm::dvec2 size(camera.lens.size_px);
    frame.ray_origin = glm::vec4(platform::forward(camera.pose) - right - up, 0.0);
    frame.ray_dx = glm::vec4(right * (2.0 / size.x), 0.0);
    frame.ray_dy = glm::vec4(up * (2.0 / size.y), 0.0);
}

// The share of a repeat at which the eye stands, so that what is drawn there does not depend on the eye.
glm::vec2 noise_offset(const glm::dvec3& eye_m, double repeat_m) {
    return glm::vec2(glm::fract(glm::dvec2(eye_m) / repeat_m));
}

void set_ground(const FrameView& view, const io::TerrainInfo& info, shaders::FrameUniforms& frame) {
    const double lowest_m = std::min(std::max(info.min_height_m, 0.0), info.max_height_m);
    const double highest_m = std::max(info.max_height_m, lowest_m + kLeastZoneRange_m);
    frame.tint_range_m = glm::vec4(lowest_m, highest_m, 0.0, 0.0);
    const glm::dvec3& eye_m = view.camera.pose.eye_m;
    frame.noise_offset = glm::vec4(noise_offset(eye_m, kFineNoise_m), noise_offset(eye_m, kBroadNoise_m));
    // Before a plain background colours are those of the data alone.
    const double natural = view.background ? 0.0 : 1.0;
    frame.noise_scale = glm::vec4(1.0 / kFineNoise_m, 1.0 / kBroadNoise_m, natural, natural);
}

void set_light(const FrameView& view, const io::TerrainInfo& info, shaders::FrameUniforms& frame) {
    const glm::dvec3 sun = sun_direction(view.daylight);
    const double drawn_m = view.camera.pose.eye_m.z - info.height_offset_m;
    frame.sun_direction = glm::vec4(glm::vec3(sun), info.height_offset_m + drawn_m / view.exaggeration);
    frame.sun_light = glm::vec4(sun_light(sun.z), 0.0f);
    frame.sky_light = glm::vec4(sky_light(sun.z), 0.0f);
}

}  // namespace

glm::dvec3 sun_direction(const Daylight& daylight) {
    const double level = std::cos(daylight.sun_elevation.radians());
    return {level * std::sin(daylight.sun_azimuth.radians()),
            level * std::cos(daylight.sun_azimuth.radians()), std::sin(daylight.sun_elevation.radians())};
}

shaders::FrameUniforms frame_uniforms(const FrameView& view, const io::TerrainInfo& info) {
    shaders::FrameUniforms frame{};
    const select::EyeFrame& eye = view.eye;
    frame.clip_from_eye = glm::mat4(platform::clip_from_eye_world(view.camera));
    set_rays(view.camera, frame);
    frame.scale = glm::vec4(eye.spacing_m, eye.quantum_m, 1.0 / view.exaggeration);
    frame.eye_rest = glm::vec4(eye.cell_rest, eye.quanta_rest, 0.0f);
    frame.eye_cell = glm::ivec4(eye.quanta, view.finer_octaves, 0, 0);
    set_light(view, info, frame);
    set_ground(view, info, frame);
    if (const auto& plain = view.background)
        frame.background = glm::vec4(plain->red, plain->green, plain->blue, 1.0);
    return frame;
}

}  // namespace ridgeline::render
