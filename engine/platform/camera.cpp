// Reverse-Z with the far plane at infinity after E. Lengyel, "Projection Matrix Tricks" (GDC 2007), and N.
// Reed, "Depth Precision Visualized" (2015): depth = near / distance, exact to float's relative precision at
// every distance.
#include "ridgeline/platform/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ridgeline::platform {

namespace {

// Half fields of view at or past this count as half a sphere: the planes would no longer bound what can be
// seen.
constexpr Angle kWidest = Angle::from_degrees(89.0);

Frustum::Plane through_eye(const glm::dvec3& eye, const glm::dvec3& inward) {
    return {inward, -glm::dot(inward, eye)};
}

// Every direction within `margin` of a view of half angles (a, b) lies within a + asin(sin margin / cos b) of
// its axis plane: a cap of angular radius m about a point at latitude b reaches that far in longitude
// (spherical sine rule).
Angle widened(double half, double other_half, Angle margin) {
    const double reach = std::sin(margin.radians()) / std::cos(other_half);
    if (reach >= 1.0) return kWidest;
    return Angle::from_radians(half + std::asin(reach));
}

Frustum everything() {
    Frustum all;
    all.planes.fill({glm::dvec3(0.0), 1.0});
    return all;
}

}  // namespace

glm::dvec3 forward(const Pose& pose) {
    const double level = std::cos(pose.pitch.radians());
    return {level * std::sin(pose.heading.radians()), level * std::cos(pose.heading.radians()),
            std::sin(pose.pitch.radians())};
}

glm::dvec3 right(const Pose& pose) {
    return {std::cos(pose.heading.radians()), -std::sin(pose.heading.radians()), 0.0};
}

glm::dvec3 up(const Pose& pose) { return glm::cross(right(pose), forward(pose)); }

Pose looking_along(const glm::dvec3& eye_m, const glm::dvec3& direction) {
    const double level = std::hypot(direction.x, direction.y);
    return {eye_m, Angle::from_radians(level > 0.0 ? std::atan2(direction.x, direction.y) : 0.0),
            Angle::from_radians(std::atan2(direction.z, level))};
}

Angle shortest_turn(Angle from, Angle to) {
    constexpr double kTurn = 2.0 * std::numbers::pi;
    const double difference = (to - from).radians();
    const double turned = difference - kTurn * std::floor(difference / kTurn + 0.5);
    return Angle::from_radians(turned);
}

glm::dvec2 half_tangents(const Lens& lens) {
    const double across = std::tan(lens.horizontal_fov.radians() / 2.0);
    return {across, across * lens.size_px.y / lens.size_px.x};
}

double pixels_per_tangent(const Lens& lens) { return lens.size_px.x / (2.0 * half_tangents(lens).x); }

glm::dmat3 view_from_world(const Pose& pose) {
    return glm::transpose(glm::dmat3(right(pose), up(pose), -forward(pose)));
}

glm::dmat4 clip_from_view(const Lens& lens) {
    const glm::dvec2 tangents = half_tangents(lens);
    glm::dmat4 clip(0.0);
    clip[0][0] = 1.0 / tangents.x;
    clip[1][1] = 1.0 / tangents.y;
    clip[2][3] = -1.0;
    clip[3][2] = lens.near_m;
    return clip;
}

glm::dmat4 clip_from_eye_world(const Camera& camera) {
    return clip_from_view(camera.lens) * glm::dmat4(view_from_world(camera.pose));
}

Frustum frustum(const Camera& camera, Angle margin) {
    const glm::dvec2 half = glm::atan(half_tangents(camera.lens));
    const Angle across = widened(half.x, half.y, margin);
    const Angle along = widened(half.y, half.x, margin);
    if (margin > Angle() && std::max(across, along) >= kWidest) return everything();

    const glm::dvec3& eye = camera.pose.eye_m;
    const glm::dvec3 ahead = forward(camera.pose);
    const auto side = [&](const glm::dvec3& outward, Angle angle) {
        return through_eye(eye, ahead * std::sin(angle.radians()) - outward * std::cos(angle.radians()));
    };
    // A turned camera's near plane may come as close as the eye.
    Frustum::Plane near_plane = through_eye(eye, ahead);
    if (margin == Angle()) near_plane.offset -= camera.lens.near_m;
    const glm::dvec3 side_axis = right(camera.pose);
    const glm::dvec3 up_axis = up(camera.pose);
    return Frustum{{side(-side_axis, across), side(side_axis, across), side(-up_axis, along),
                    side(up_axis, along), near_plane}};
}

}  // namespace ridgeline::platform
