#include "ridgeline/select/surface_query.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ridgeline/select/query_ground.h"
#include "ridgeline/select/ray_walk.h"

namespace ridgeline::select {
namespace {

// Coordinates that went through text and back still name the sample they meant.
constexpr double kSnap = 1e-6;

double snapped(double coordinate) {
    const double whole = std::round(coordinate);
    return std::abs(coordinate - whole) < kSnap ? whole : coordinate;
}

// A line of sight may run that far under the surface: its ends stand on it, but for rounding.
constexpr double kGraze_m = 1e-3;

// A ray with what is left of its reach, from where it comes near the ground: however far away it begins, its
// distances are told as finely as ground is.
struct NearRay {
    LatticeRay ray;
    double skipped_m = 0.0;
    Interval reach;
};

// top_m: over all ground.
NearRay near_ray(const io::TerrainInfo& info, double top_m, const glm::dvec3& origin_m,
                 const glm::dvec3& unit, double length_m) {
    LatticeRay ray{{info.lattice(origin_m.x, origin_m.y), origin_m.z},
                   {unit.x / info.spacing_x_m, -unit.y / info.spacing_y_m, unit.z}};
    // A ray along a line of the lattice, or the raster's edge, is on it.
    for (int axis = 0; axis < 2; ++axis)
        if (ray.slope[axis] == 0.0) ray.origin[axis] = snapped(ray.origin[axis]);
    Interval t{0.0, length_m};
    t = clipped(t, ray.origin.x, ray.slope.x, 0.0, static_cast<double>(info.width - 1));
    t = clipped(t, ray.origin.y, ray.slope.y, 0.0, static_cast<double>(info.height - 1));
    t = clipped(t, ray.origin.z, ray.slope.z, -std::numeric_limits<double>::infinity(), top_m);
    if (t.empty()) return {ray, 0.0, t};
    ray.origin = ray.at(t.from);
    return {ray, t.from, {0.0, t.to - t.from}};
}

bool finite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

Result<glm::dvec3> unit_of(const glm::dvec3& origin_m, const glm::dvec3& direction) {
    const double greatest = std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)});
    if (!finite(origin_m) || !finite(direction)) return Error{"ray: a place or direction that is not finite"};
    if (greatest == 0.0) return Error{"ray: a direction of no length"};
    return glm::normalize(direction / greatest);
}

}  // namespace

struct SurfaceQuery::State {
    State(const io::Store& store, const SurfaceQueryOptions& options)
        : ground(store, options.detail_levels, std::max<std::size_t>(options.cached_tiles, 1)) {}

    QueryGround ground;

    Result<RayHit> follow(const glm::dvec3& origin_m, const glm::dvec3& direction, double length_m,
                          RayWalk::Ends ends) {
        const auto unit = unit_of(origin_m, direction);
        if (!unit) return unit.error();
        const NearRay near = near_ray(ground.info(), ground.top_m(), origin_m, *unit, length_m);
        const auto met = RayWalk(ground, ground.grid(), ends).first(near.ray, near.reach);
        if (!met) return met.error();
        if (!*met) return RayHit{};
        const glm::dvec3 place = near.ray.at(**met);
        return RayHit{true, near.skipped_m + **met, {ground.info().world(place.x, place.y), place.z}};
    }
};

SurfaceQuery::SurfaceQuery(const io::Store& store, const SurfaceQueryOptions& options)
    : state_(std::make_unique<State>(store, options)) {}
SurfaceQuery::~SurfaceQuery() = default;
SurfaceQuery::SurfaceQuery(SurfaceQuery&&) noexcept = default;
SurfaceQuery& SurfaceQuery::operator=(SurfaceQuery&&) noexcept = default;

Result<SurfaceHeight> SurfaceQuery::height(double east_m, double north_m) {
    const glm::dvec2 place = state_->ground.info().lattice(east_m, north_m);
    return height_at(place.x, place.y);
}

Result<SurfaceHeight> SurfaceQuery::height_at(double column, double row) {
    const io::Grid& grid = state_->ground.grid();
    column = snapped(column);
    row = snapped(row);
    // Written so that what is not a number is outside.
    if (!(column >= 0.0 && row >= 0.0 && column <= static_cast<double>(grid.width() - 1) &&
          row <= static_cast<double>(grid.height() - 1)))
        return SurfaceHeight{SurfaceHeight::Kind::outside, 0.0};
    const auto height_m = state_->ground.height_m(column, row);
    if (!height_m) return height_m.error();
    if (!height_m->has_value()) return SurfaceHeight{SurfaceHeight::Kind::nodata, 0.0};
    return SurfaceHeight{SurfaceHeight::Kind::ground, **height_m};
}

Result<RayHit> SurfaceQuery::ray_cast(const glm::dvec3& origin_m, const glm::dvec3& direction,
                                      double max_distance_m) {
    return state_->follow(origin_m, direction, max_distance_m, RayWalk::Ends::at_surface);
}

Result<LineOfSight> SurfaceQuery::line_of_sight(const glm::dvec3& from_m, const glm::dvec3& to_m) {
    const glm::dvec3 graze_m(0.0, 0.0, kGraze_m);
    const glm::dvec3 direction = from_m == to_m ? glm::dvec3(0.0, 0.0, 1.0) : to_m - from_m;
    auto hidden =
        state_->follow(from_m + graze_m, direction, glm::distance(from_m, to_m), RayWalk::Ends::under_ground);
    if (!hidden) return hidden.error();
    if (hidden->hit) hidden->point_m -= graze_m;
    return LineOfSight{.clear = !hidden->hit, .hidden_by = *hidden};
}

}  // namespace ridgeline::select
