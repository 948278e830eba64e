#include "ridgeline/select/sun_view.h"

#include <cmath>

namespace ridgeline::select {

SunAxes sun_axes(Angle azimuth, Angle elevation) {
    const double east = std::sin(azimuth.radians()), north = std::cos(azimuth.radians());
    const double level = std::cos(elevation.radians()), up = std::sin(elevation.radians());
    return {.across = {-north, east, 0.0},
            .along = {-up * east, -up * north, level},
            .towards = {level * east, level * north, up}};
}

SunBox sun_box(const SunAxes& axes, const glm::dvec3& eye_m, const Box& box) {
    const glm::dvec3 centre = 0.5 * (box.min + box.max) - eye_m, half = 0.5 * (box.max - box.min);
    const auto project = [&](const glm::dvec3& axis) {
        return glm::dvec2(glm::dot(axis, centre), glm::dot(glm::abs(axis), half));
    };
    const glm::dvec2 x = project(axes.across), y = project(axes.along), z = project(axes.towards);
    return {{x.x - x.y, y.x - y.y, z.x - z.y}, {x.x + x.y, y.x + y.y, z.x + z.y}};
}

const ShadowReach& SunView::reach_at(double distance_m) const {
    std::size_t i = 0;
    while (i + 1 < reach_count && reaches[i + 1].from_m <= distance_m) ++i;
    return reaches[i];
}

}  // namespace ridgeline::select
