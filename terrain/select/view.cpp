#include "ridgeline/select/view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "ridgeline/base/contract.h"

namespace ridgeline::select {
namespace {

// How far a terrain's heights or samples may lie from EyeFrame's place so that floats still hold them
// exactly.
constexpr double kExactInFloat = 16777216.0;

Frustum::Plane plane_through(const glm::dvec3& eye, const glm::dvec3& normal) {
    const glm::dvec3 unit = glm::normalize(normal);
    return {unit, -glm::dot(unit, eye)};
}

Frustum padded_frustum(const Camera& camera) {
    const double half_width = std::tan(camera.horizontal_field.radians() / 2.0);
    const double pixel = 2.0 * half_width / camera.width_px;
    const double x = half_width + pixel;
    const double y = half_width * camera.height_px / camera.width_px + pixel;
    const glm::dvec3& f = camera.forward;
    return {{plane_through(camera.eye_m, x * f + camera.right),
             plane_through(camera.eye_m, x * f - camera.right),
             plane_through(camera.eye_m, y * f + camera.up), plane_through(camera.eye_m, y * f - camera.up),
             plane_through(camera.eye_m, f)}};
}

// From the view's axis to the corner of the picture.
Angle half_diagonal(const Camera& camera) {
    const double x = std::tan(camera.horizontal_field.radians() / 2.0);
    return Angle::from_radians(
        std::atan(x * std::hypot(1.0, static_cast<double>(camera.height_px) / camera.width_px)));
}

ExtensionZone zone_of(const Camera& camera, const ViewOptions& options) {
    const double latency_s = options.paging_latency.count();
    const Angle reach = half_diagonal(camera) + options.resting_margin + camera.turn_per_second * latency_s;
    return {camera.forward, std::min(reach, Angle::from_degrees(180.0)), camera.speed_m_per_s * latency_s};
}

// Where the camera's right hand points decides the heading, so that it is one when it looks straight down
// too; lying on its side, north is as good as any.
glm::dvec2 heading_of(const Camera& camera) {
    const glm::dvec2 heading(-camera.right.y, camera.right.x);
    const double length = glm::length(heading);
    return length > 1e-6 ? heading / length : glm::dvec2(0.0, 1.0);
}

// The whole number on the terrain nearest to a coordinate, and what is left.
void split(double coordinate, double least, double most, int& whole, float& rest) {
    const double place = std::floor(std::clamp(coordinate, least, most));
    whole = static_cast<int>(place);
    rest = static_cast<float>(coordinate - place);
}

}  // namespace

ExtensionZone::ExtensionZone(const glm::dvec3& along, Angle half_angle, double margin)
    : direction(along),
      cos_half_angle(std::cos(half_angle.radians())),
      sin_half_angle(std::sin(half_angle.radians())),
      margin_m(margin) {}

bool touches(const ExtensionZone& zone, const glm::dvec3& eye_m, const glm::dvec3& centre_m,
             double radius_m) {
    const glm::dvec3 to_centre = centre_m - eye_m;
    const double reach_m = radius_m + zone.margin_m;
    const double squared = glm::dot(to_centre, to_centre);
    if (squared <= reach_m * reach_m) return true;
    const double along = glm::dot(to_centre, zone.direction);
    const double across = std::sqrt(std::max(squared - along * along, 0.0));
    // Signed distance to the cone's surface, prolonged beyond its apex: never more than the true one.
    return across * zone.cos_half_angle - along * zone.sin_half_angle <= reach_m;
}

View make_view(const Camera& camera, const ViewOptions& options) {
    RIDGELINE_CHECK(camera.width_px > 0 && camera.height_px > 0);
    RIDGELINE_CHECK(options.exaggeration > 0.0 && options.pixel_error_px > 0.0);
    View view;
    view.eye_m = camera.eye_m;
    view.visible = padded_frustum(camera);
    // The frustum is a pixel wider than the picture; a hundredth more is more than that.
    view.picture = {camera.forward, half_diagonal(camera) * 1.01, 0.0};
    view.extension = zone_of(camera, options);
    view.projection_px = camera.width_px / 2.0 / std::tan(camera.horizontal_field.radians() / 2.0);
    view.pixel_error_px = options.pixel_error_px;
    view.exaggeration = options.exaggeration;
    view.eye_above_ground_m = options.eye_above_ground_m;
    view.horizon = options.horizon;
    view.beside_finest_m = options.beside_finest_m;
    view.heading = heading_of(camera);
    view.near_reach_m = camera.near_m / std::cos(half_diagonal(camera).radians());
    view.expected_rise_m = options.steepest_climb * camera.speed_m_per_s * options.paging_latency.count();
    return view;
}

// A node's record bounds those below it, so level 0 bounds all.
Box drawn_bounds(const io::TerrainInfo& info, std::span<const io::NodeRecord> records, double exaggeration) {
    std::int32_t lowest = std::numeric_limits<std::int32_t>::max();
    std::int32_t highest = std::numeric_limits<std::int32_t>::min();
    for (const io::NodeRecord& root : records.first(static_cast<std::size_t>(info.grid().first(1)))) {
        if (!root.has_data()) continue;
        lowest = std::min(lowest, root.min_quanta);
        highest = std::max(highest, root.max_quanta);
    }
    const double quantum_m = info.quantum_m * exaggeration;
    return {{info.min_east_m(), info.min_north_m(), info.height_offset_m + lowest * quantum_m},
            {info.max_east_m(), info.max_north_m(), info.height_offset_m + highest * quantum_m}};
}

EyeFrame eye_frame(const View& view, const io::TerrainInfo& info) {
    return eye_frame(view.eye_m, view.exaggeration, info);
}

EyeFrame eye_frame(const glm::dvec3& eye_m, double exaggeration, const io::TerrainInfo& info) {
    const glm::dvec2 place = info.lattice(eye_m.x, eye_m.y);
    const double quantum_m = info.quantum_m * exaggeration;
    const double quanta = (eye_m.z - info.height_offset_m) / quantum_m;
    const double lowest = (info.min_height_m - info.height_offset_m) / info.quantum_m;
    const double highest = (info.max_height_m - info.height_offset_m) / info.quantum_m;
    EyeFrame frame;
    split(place.x, 0.0, std::min(static_cast<double>(info.width - 1), kExactInFloat), frame.cell.x,
          frame.cell_rest.x);
    split(place.y, 0.0, std::min(static_cast<double>(info.height - 1), kExactInFloat), frame.cell.y,
          frame.cell_rest.y);
    split(quanta, lowest, std::max(lowest, highest), frame.quanta, frame.quanta_rest);
    frame.spacing_m = {static_cast<float>(info.spacing_x_m), static_cast<float>(info.spacing_y_m)};
    frame.quantum_m = static_cast<float>(quantum_m);
    return frame;
}

}  // namespace ridgeline::select
