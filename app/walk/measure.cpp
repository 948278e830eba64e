#include "ridgeline/app/walk/measure.h"

#include <algorithm>
#include <cmath>

namespace ridgeline::app {
namespace {

// A hand is not quite still while it clicks.
constexpr double kClickSlop_px = 4.0;
constexpr std::size_t kMostSamples = 512;

}  // namespace

GroundRay ray_through(const platform::Camera& camera, const VerticalScale& scale,
                      const glm::dvec2& picture_place) {
    const glm::dvec2 tangents = platform::half_tangents(camera.lens);
    const glm::dvec2 across = glm::dvec2(2.0 * picture_place.x - 1.0, 1.0 - 2.0 * picture_place.y) * tangents;
    const platform::Pose& pose = camera.pose;
    glm::dvec3 direction =
        platform::forward(pose) + across.x * platform::right(pose) + across.y * platform::up(pose);
    direction.z /= scale.exaggeration;
    return {{glm::dvec2(pose.eye_m), scale.true_m(pose.eye_m.z)}, direction};
}

std::optional<glm::dvec2> picture_place(const platform::Camera& camera, const VerticalScale& scale,
                                        const glm::dvec3& point_m) {
    const glm::dvec3 drawn(glm::dvec2(point_m), scale.drawn_m(point_m.z));
    const glm::dvec4 clip =
        platform::clip_from_eye_world(camera) * glm::dvec4(drawn - camera.pose.eye_m, 1.0);
    if (clip.w < camera.lens.near_m) return std::nullopt;
    return glm::dvec2(0.5 + 0.5 * clip.x / clip.w, 0.5 - 0.5 * clip.y / clip.w);
}

std::size_t profile_samples(const glm::dvec3& from_m, const glm::dvec3& to_m, double spacing_m) {
    const double steps = std::ceil(glm::distance(glm::dvec2(from_m), glm::dvec2(to_m)) / spacing_m);
    return static_cast<std::size_t>(std::clamp(steps, 1.0, kMostSamples - 1.0)) + 1;
}

LineFigures line_figures(const glm::dvec3& from_m, const glm::dvec3& to_m, std::span<const float> profile) {
    const glm::dvec3 between = to_m - from_m;
    LineFigures line{.level_m = glm::length(glm::dvec2(between)),
                     .straight_m = glm::length(between),
                     .bearing = Angle::from_radians(std::atan2(between.x, between.y)),
                     .rise_m = between.z,
                     .lowest_m = std::min(from_m.z, to_m.z),
                     .highest_m = std::max(from_m.z, to_m.z)};
    if (line.bearing < Angle()) line.bearing = line.bearing + Angle::from_degrees(360.0);
    std::optional<double> before_m;
    for (const float sample : profile) {
        const auto height_m = static_cast<double>(sample);
        if (std::isnan(height_m)) continue;
        const double step_m = before_m ? height_m - *before_m : 0.0;
        (step_m > 0.0 ? line.ascent_m : line.descent_m) += std::abs(step_m);
        line.lowest_m = std::min(line.lowest_m, height_m);
        line.highest_m = std::max(line.highest_m, height_m);
        before_m = height_m;
    }
    return line;
}

std::optional<Click> ClickWatch::update(const platform::Input& input) {
    std::optional<Click> clicked;
    for (std::size_t i = 0; i < presses_.size(); ++i) {
        const auto button = static_cast<platform::MouseButton>(i);
        Press& press = presses_[i];
        // What moved in the frame of the press moved before it, as for looking around.
        if (input.pressed(button))
            press = {.down = true, .moved_px = 0.0, .at_px = input.mouse_position_px};
        else
            press.moved_px += std::abs(input.mouse_motion_px.x) + std::abs(input.mouse_motion_px.y);
        if (!press.down || input.down(button)) continue;
        press.down = false;
        if (!input.mouse_captured && press.moved_px <= kClickSlop_px) clicked = {button, press.at_px};
    }
    return clicked;
}

}  // namespace ridgeline::app
