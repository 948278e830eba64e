// The camera: where the eye is, where it looks, and the matrices and planes that follow from that.
//
// World: metres, x east, y north, z up, double. View: x right, y up, looking along -z. Clip: depth from 0
// (infinitely far) to 1 (the near plane), GL_ZERO_TO_ONE. Matrices carry no translation of the eye: positions
// are made relative to it in double or integer arithmetic first, which is what keeps the picture still far
// from the origin. Plain values; free functions; any thread.
#pragma once

#include <glm/glm.hpp>

#include "ridgeline/base/geometry.h"
#include "ridgeline/base/units.h"

namespace ridgeline::platform {

// An eye's place and direction, as recorded paths hold them.
struct Pose {
    glm::dvec3 eye_m{0.0};
    Angle heading{};  // clockwise from north
    Angle pitch{};    // up from level
};

struct Lens {
    Angle horizontal_fov = Angle::from_degrees(75.0);
    glm::ivec2 size_px{1024, 768};
    // A tenth of a metre costs nothing: reverse-Z depth in float has the same relative precision everywhere.
    double near_m = 0.1;
};

struct Camera {
    Pose pose;
    Lens lens;
};

// Unit vectors in the world.
glm::dvec3 forward(const Pose& pose);
glm::dvec3 right(const Pose& pose);
glm::dvec3 up(const Pose& pose);

// The heading and pitch that look along `direction` (any length but 0). Straight up or down, the heading is
// 0.
Pose looking_along(const glm::dvec3& eye_m, const glm::dvec3& direction);

// The angle in [-180°, 180°) that turns `from` into `to` the short way.
Angle shortest_turn(Angle from, Angle to);

// tan of half the field of view, x across and y up: the view is |x| <= tangent.x * -z, |y| <= tangent.y * -z.
glm::dvec2 half_tangents(const Lens& lens);

// Pixels that a length of one metre covers one metre ahead: projected size = this * length / distance.
double pixels_per_tangent(const Lens& lens);

glm::dmat3 view_from_world(const Pose& pose);
glm::dmat4 clip_from_view(const Lens& lens);
// From world axes with the eye as origin; float for the GPU is `glm::mat4(clip_from_eye_world(camera))`.
glm::dmat4 clip_from_eye_world(const Camera& camera);

// The view as half-spaces in the world. With a margin it also holds every view that a turn of the camera by
// that angle, about any axis, can give; where that is half a sphere or more, it holds everything.
Frustum frustum(const Camera& camera, Angle margin = Angle());

}  // namespace ridgeline::platform
