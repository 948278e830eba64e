#include "ridgeline/base/geometry.h"

namespace ridgeline {

double distance(const glm::dvec3& point, const Box& box) {
    const glm::dvec3 outside = glm::max(glm::max(box.min - point, point - box.max), glm::dvec3(0.0));
    return glm::length(outside);
}

Containment contains(const Frustum& frustum, const Box& box) {
    bool inside = true;
    for (const auto& plane : frustum.planes) {
        const auto positive = glm::greaterThanEqual(plane.normal, glm::dvec3(0.0));
        const glm::dvec3 far_corner = glm::mix(box.min, box.max, glm::dvec3(positive));
        const glm::dvec3 near_corner = glm::mix(box.max, box.min, glm::dvec3(positive));
        if (glm::dot(plane.normal, far_corner) + plane.offset < 0.0) return Containment::outside;
        inside = inside && glm::dot(plane.normal, near_corner) + plane.offset >= 0.0;
    }
    return inside ? Containment::inside : Containment::partly;
}

}  // namespace ridgeline
