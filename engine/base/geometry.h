// Boxes, frusta and rays in the world frame: metres, x east, y north, z up, double precision.
#pragma once

#include <array>
#include <glm/glm.hpp>

namespace ridgeline {

// An axis-aligned box; empty when any min exceeds its max.
struct Box {
    glm::dvec3 min{0.0};
    glm::dvec3 max{0.0};
};

// The distance from a point to the nearest point of a box, 0 inside; metres.
double distance(const glm::dvec3& point, const Box& box);

// Five half-spaces (no far plane; depth is infinite), inward normals: inside where dot(normal, p) + offset >=
// 0.
struct Frustum {
    struct Plane {
        glm::dvec3 normal{0.0};
        double offset = 0.0;
    };
    std::array<Plane, 5> planes;
};

enum class Containment { outside, partly, inside };

// Conservative: a box outside no single plane counts as partly in.
Containment contains(const Frustum& frustum, const Box& box);

}  // namespace ridgeline
