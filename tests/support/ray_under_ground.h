// Whether a pixel looks at the ground, by the ground's heights: what tells a crack from sky between needles.
//
// Terrain that follows on a pixel's line through the nadir means ground in front only as far as the picture
// resolves it: needles narrower than a pixel leave sky between them and terrain around it. A ray that is
// somewhere under the drawn surface cannot end in the sky, whatever its neighbours show.
#pragma once

#include <algorithm>
#include <glm/glm.hpp>
#include <optional>

#include "ridgeline/platform/camera.h"

namespace ridgeline::test {

// The direction of a place in the picture, in pixels from its upper left corner; not of unit length.
inline glm::dvec3 ray_through(const platform::Camera& camera, const glm::dvec2& place_px) {
    const glm::dvec2 size(camera.lens.size_px), tangents = platform::half_tangents(camera.lens);
    const glm::dvec2 ray =
        glm::dvec2(2.0 * place_px.x / size.x - 1.0, 1.0 - 2.0 * place_px.y / size.y) * tangents;
    return glm::transpose(platform::view_from_world(camera.pose)) * glm::dvec3(ray, -1.0);
}

// height_m: std::optional<double>(east and north), in metres of the picture; empty beyond the ground. Looks
// `step_m` by `step_m` as far as reach_m.
template <class Height>
bool runs_under_ground(const glm::dvec3& eye_m, const glm::dvec3& direction, double step_m, double reach_m,
                       const Height& height_m) {
    const glm::dvec3 unit = glm::normalize(direction);
    for (double along_m = step_m; along_m < reach_m; along_m += step_m) {
        const glm::dvec3 at_m = eye_m + along_m * unit;
        const std::optional<double> ground_m = height_m(glm::dvec2(at_m));
        if (ground_m && at_m.z < *ground_m) return true;
    }
    return false;
}

// Rasterisers snap vertices to fractions of a pixel: all rays within 1/64 pixel of the pixel's centre must
// look at the ground.
template <class Height>
bool looks_at_ground(const platform::Camera& camera, const glm::ivec2& pixel, double step_m, double reach_m,
                     const Height& height_m) {
    constexpr double kSnap_px = 1.0 / 64.0;
    constexpr glm::dvec2 kAround[] = {
        {0.0, 0.0}, {kSnap_px, 0.0}, {-kSnap_px, 0.0}, {0.0, kSnap_px}, {0.0, -kSnap_px}};
    return std::ranges::all_of(kAround, [&](const glm::dvec2& aside) {
        const glm::dvec3 ray = ray_through(camera, glm::dvec2(pixel) + 0.5 + aside);
        return runs_under_ground(camera.pose.eye_m, ray, step_m, reach_m, height_m);
    });
}

}  // namespace ridgeline::test
