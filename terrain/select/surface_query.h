// Questions to a store about its surface, answered from disk through small caches: heights, ray casts, and
// the finest triangulation to stand on. They block on reads: for tools, tests and start-up, never for the
// render thread. One thread at a time per object; the store outlives it.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <memory>
#include <optional>

#include "ridgeline/base/result.h"
#include "ridgeline/io/store.h"

namespace ridgeline::select {

struct SurfaceHeight {
    enum class Kind { ground, nodata, outside };
    Kind kind = Kind::outside;
    double height_m = 0.0;  // of ground
};

struct RayHit {
    bool hit = false;
    // Of a hit: how far along the ray, and where.
    double distance_m = 0.0;
    glm::dvec3 point_m{0.0};
};

struct LineOfSight {
    bool clear = true;
    // Where the line first runs under ground, unless it is clear.
    RayHit hidden_by;
};

struct SurfaceQueryOptions {
    std::size_t cached_tiles = 64;
    // Octaves of ground finer than the source (terrain/detail), of those that the store foretells: TerrainInfo::detail.
    int detail_levels = 0;
};

// The finest heights level, or the finest one of the ground made below it, bilinear between samples; no exaggeration.
class SurfaceQuery {
  public:
    explicit SurfaceQuery(const io::Store& store, const SurfaceQueryOptions& options = {});
    ~SurfaceQuery();
    SurfaceQuery(SurfaceQuery&&) noexcept;
    SurfaceQuery& operator=(SurfaceQuery&&) noexcept;

    // A sample whose weight is zero does not matter; any other invalid one makes nodata. Outside: beyond the
    // centres of the outermost samples. Coordinates in the store's CRS.
    Result<SurfaceHeight> height(double east_m, double north_m);
    // The same in lattice coordinates.
    Result<SurfaceHeight> height_at(double column, double row);

    // The nearest point of the surface on a ray, from above or below: exact, the roots of each cell's bilinear
    // patch and nothing stepped over. Where a cell has an invalid corner there is no ground, nor beyond the
    // outermost samples; a ray in the plane of a line of samples sees those alone, as heights do there. A ray
    // that begins on the surface hits at 0. Made ground is met where it is, unless it lies farther from the ground
    // that it is made of than detail::made_range believes. direction: of any length but zero, a Result error otherwise, or
    // where anything is not finite (max_distance_m may be infinite). Straight lines in the store's CRS: the
    // earth does not curve.
    Result<RayHit> ray_cast(const glm::dvec3& origin_m, const glm::dvec3& direction, double max_distance_m);
    // Whether the straight line between two places is nowhere more than a millimetre under that surface. So
    // ends may stand on the ground; one under it sees nothing. Holes hide nothing.
    Result<LineOfSight> line_of_sight(const glm::dvec3& from_m, const glm::dvec3& to_m);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

struct FinestSurfaceOptions {
    std::size_t cached_chunks = 16;
};

// The triangulation of the finest chunks, unmorphed: what a walker stands on. Without exaggeration.
class FinestSurface {
  public:
    explicit FinestSurface(const io::Store& store, const FinestSurfaceOptions& options = {});
    ~FinestSurface();
    FinestSurface(FinestSurface&&) noexcept;
    FinestSurface& operator=(FinestSurface&&) noexcept;

    // Empty outside the terrain and over nodes without data; over filled nodata, the fill.
    Result<std::optional<double>> height(double east_m, double north_m);
    Result<std::optional<double>> height_at(double column, double row);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace ridgeline::select
