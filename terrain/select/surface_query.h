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
    double distance_m = 0.0;
    glm::dvec3 point_m{0.0};
};

struct SurfaceQueryOptions {
    std::size_t cached_tiles = 64;
    // Octaves of ground finer than the source (terrain/detail), of those that the store foretells: TerrainInfo::detail.
    int detail_levels = 0;
};

// The finest heights level, or the finest one of the ground made below it, bilinear between samples; no exaggeration.
// Ray casts know the source's ground alone.
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

    // The nearest point of the surface on a ray, exact for the bilinear patches; cells with an invalid corner
    // are holes. Empty: no hit within max_distance_m. direction need not be of unit length, but not zero.
    Result<std::optional<RayHit>> ray_cast(const glm::dvec3& origin_m, const glm::dvec3& direction,
                                           double max_distance_m);

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
