// Counts background pixels where terrain must be: cracks.
//
// Every vertical plane through the eye is a line of the picture through the projected nadir. Over a height
// field without holes, with the eye above it, such a line shows terrain from the nadir up to the horizon and
// sky beyond. So background is wrong wherever terrain follows on its line, away from the nadir.
//
// Looks at each pixel of the picture once, and follows lines only as far as there is terrain: quick enough for
// every frame of a walk. Values; any thread; the picture must outlive it.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <vector>

#include "ridgeline/gl/screenshot.h"
#include "ridgeline/platform/camera.h"

namespace ridgeline::app {

class BackgroundPixels {
  public:
    BackgroundPixels(const gl::Image& image, const glm::ivec3& background)
        : image_(image), background_(background) {
        for (int y = 0; y < image.size_px.y; ++y)
            for (int x = 0; x < image.size_px.x; ++x)
                if (is_firm_terrain({x, y})) hold({x, y});
    }

    int count() const {
        int sum = 0;
        for (int y = 0; y < image_.size_px.y; ++y)
            for (int x = 0; x < image_.size_px.x; ++x) sum += is_background({x, y}) ? 1 : 0;
        return sum;
    }

    int count_wrong(const platform::Camera& camera) const { return static_cast<int>(wrong(camera).size()); }

    std::vector<glm::ivec2> wrong(const platform::Camera& camera) const {
        const glm::dvec3 nadir = platform::view_from_world(camera.pose) * glm::dvec3(0.0, 0.0, -1.0);
        std::vector<glm::ivec2> pixels;
        for (int y = 0; y < image_.size_px.y; ++y)
            for (int x = 0; x < image_.size_px.x; ++x)
                if (is_background({x, y}) && terrain_follows({x, y}, nadir, camera.lens))
                    pixels.emplace_back(x, y);
        return pixels;
    }

  private:
    void hold(const glm::ivec2& p) {
        least_ = glm::min(least_, p);
        most_ = glm::max(most_, p);
    }
    // Whether going on from there, terrain could still come.
    bool past_terrain(const glm::ivec2& p, const glm::dvec2& step) const {
        return (step.x <= 0.0 && p.x < least_.x) || (step.x >= 0.0 && p.x > most_.x) ||
               (step.y <= 0.0 && p.y < least_.y) || (step.y >= 0.0 && p.y > most_.y);
    }
    bool inside(const glm::ivec2& p) const {
        return p.x >= 0 && p.y >= 0 && p.x < image_.size_px.x && p.y < image_.size_px.y;
    }
    bool is_background(const glm::ivec2& p) const {
        const std::byte* rgb =
            &image_.rgb[3 * (static_cast<std::size_t>(p.y) * static_cast<std::size_t>(image_.size_px.x) +
                             static_cast<std::size_t>(p.x))];
        return glm::ivec3(std::to_integer<int>(rgb[0]), std::to_integer<int>(rgb[1]),
                          std::to_integer<int>(rgb[2])) == background_;
    }
    // With its neighbours: the line itself then crosses terrain, however its steps are rounded.
    bool is_firm_terrain(const glm::ivec2& p) const {
        for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx) {
                const glm::ivec2 q = p + glm::ivec2(dx, dy);
                if (inside(q) && is_background(q)) return false;
            }
        return true;
    }

    // Away from the nadir n, the ray (x, y, -1) moves by -(n.x + x n.z, n.y + y n.z).
    bool terrain_follows(const glm::ivec2& pixel, const glm::dvec3& nadir, const platform::Lens& lens) const {
        const glm::dvec2 size(image_.size_px), tangents = platform::half_tangents(lens);
        const glm::dvec2 centre = glm::dvec2(pixel) + 0.5;
        const glm::dvec2 ray =
            glm::dvec2(2.0 * centre.x / size.x - 1.0, 1.0 - 2.0 * centre.y / size.y) * tangents;
        glm::dvec2 outwards =
            -glm::dvec2(nadir.x + ray.x * nadir.z, nadir.y + ray.y * nadir.z) / tangents * size;
        outwards.y = -outwards.y;
        const double length = std::max(std::abs(outwards.x), std::abs(outwards.y));
        if (length < 1e-9) return true;
        outwards /= length;
        for (glm::dvec2 at = centre + outwards;; at += outwards) {
            const glm::ivec2 p(glm::floor(at));
            if (!inside(p) || past_terrain(p, outwards)) return false;
            if (is_firm_terrain(p)) return true;
        }
    }

    const gl::Image& image_;
    glm::ivec3 background_;
    // Of firm terrain.
    glm::ivec2 least_{1 << 30};
    glm::ivec2 most_{-1};
};

}  // namespace ridgeline::app
