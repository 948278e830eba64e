#include "ridgeline/select/surface_query.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ridgeline/base/contract.h"
#include "ridgeline/detail/detail_tile.h"
#include "ridgeline/select/least_recent_cache.h"
#include "ridgeline/select/ray_walk.h"

namespace ridgeline::select {
namespace {

using io::HeightsTile;
using io::NodeId;

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

struct SurfaceQuery::State final : RayGround {
    State(const io::Store& used, const SurfaceQueryOptions& options)
        : store(used),
          detail_levels(options.detail_levels),
          detail_shift(detail::detail_shift(used.info())),
          tiles(std::max<std::size_t>(options.cached_tiles, 1)) {
        const auto& foretold = used.info().detail;
        RIDGELINE_CHECK(detail_levels == 0 ||
                        (foretold && detail_levels <= static_cast<int>(foretold->octaves.size())));
        for (int octave = 0; octave <= detail_levels && detail_levels > 0; ++octave)
            detail_tiles.emplace_back(std::max<std::size_t>(options.cached_tiles, 1));
        for (std::int64_t i = 0; i < grid().first(1); ++i)
            if (const auto root = range(grid().node_at(i))) top_m = std::max(top_m, root->most_m + 1.0);
    }

    const io::Store& store;
    const int detail_levels;
    const int detail_shift;
    double top_m = -std::numeric_limits<double>::infinity();  // over all ground
    LeastRecentCache<HeightsTile> tiles;
    // By level and place: each is made from its parent.
    std::vector<LeastRecentCache<detail::DetailTile>> detail_tiles;
    std::vector<std::uint8_t> bytes;

    const io::Grid& grid() const { return store.grid(); }

    // Null where the node has no data.
    Result<const HeightsTile*> tile(NodeId node) {
        if (!store.record(node).has_data()) return static_cast<const HeightsTile*>(nullptr);
        const std::int64_t key = grid().linear(node);
        if (const HeightsTile* found = tiles.find(key)) return found;
        HeightsTile& made = tiles.make(key);
        if (const auto read = store.read_heights(node, bytes, made); !read) {
            tiles.forget(key);
            return read.error();
        }
        return static_cast<const HeightsTile*>(&made);
    }

    // A valid sample's quanta. On a border any of the nodes that share it may answer: one alone may have
    // data.
    Result<std::optional<double>> sample(std::int64_t column, std::int64_t row) {
        const int quads = grid().quads(), level = grid().finest();
        for (const std::int64_t y : {row / quads, (row - 1) / quads})
            for (const std::int64_t x : {column / quads, (column - 1) / quads}) {
                const NodeId node{level, static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)};
                if (!grid().contains(node)) continue;
                const auto found = tile(node);
                if (!found) return found.error();
                if (*found == nullptr) continue;
                const std::size_t at =
                    (*found)->at(static_cast<int>(column - x * quads), static_cast<int>(row - y * quads));
                if ((*found)->all_valid || (*found)->sample_valid[at] != 0)
                    return std::optional(static_cast<double>((*found)->quanta[at]));
                return std::optional<double>();
            }
        return std::optional<double>();
    }

    // Null where the source's tile above it has no data. column, row: of the tile, at the octave's level.
    Result<const detail::DetailTile*> detail_tile(int octave, std::int32_t column, std::int32_t row) {
        const NodeId node{grid().finest() + octave, column, row};
        const std::int64_t key = static_cast<std::int64_t>(row) << 32 | column;
        auto& made_before = detail_tiles[static_cast<std::size_t>(octave)];
        if (const detail::DetailTile* found = made_before.find(key)) return found;
        if (octave == 0) {
            const auto source = tile(node);
            if (!source) return source.error();
            if (*source == nullptr) return static_cast<const detail::DetailTile*>(nullptr);
            detail::DetailTile& root = made_before.make(key);
            detail::make_root(**source, node, detail_shift, root);
            return static_cast<const detail::DetailTile*>(&root);
        }
        const auto parent = detail_tile(octave - 1, column >> 1, row >> 1);
        if (!parent || *parent == nullptr) return parent;
        detail::DetailTile& made = made_before.make(key);
        detail::make_child(**parent, node.quarter(),
                           store.info().detail->octaves[static_cast<std::size_t>(octave - 1)], made);
        return static_cast<const detail::DetailTile*>(&made);
    }

    // Quanta of the made ground's sample, counted from the north-western one; in a cell with source ground.
    Result<std::optional<double>> detail_quanta(double column, double row) {
        const double rate = std::ldexp(1.0, detail_levels);
        const auto last = [&](std::int64_t samples) {
            return std::ldexp(static_cast<double>(samples - 1), detail_levels) - 1.0;
        };
        const double x = std::min(std::floor(column * rate), last(grid().width()));
        const double y = std::min(std::floor(row * rate), last(grid().height()));
        const int quads = grid().quads();
        const auto made = detail_tile(detail_levels, static_cast<std::int32_t>(x / quads),
                                      static_cast<std::int32_t>(y / quads));
        if (!made) return made.error();
        if (*made == nullptr) return std::optional<double>();
        const int in_x = static_cast<int>(x) % quads, in_y = static_cast<int>(y) % quads;
        const double u = column * rate - x, v = row * rate - y;
        const auto height = [&](int east, int south) {
            return static_cast<double>((*made)->height(in_x + east, in_y + south));
        };
        const double north = height(0, 0) + u * (height(1, 0) - height(0, 0));
        const double south = height(0, 1) + u * (height(1, 1) - height(0, 1));
        return std::optional(std::ldexp(north + v * (south - north), -detail_shift));
    }

    int deepest_level() const override { return grid().finest(); }
    std::optional<HeightRange> range(NodeId node) const override {
        if (!grid().contains(node) || !store.record(node).has_data()) return {};
        const io::NodeRecord& record = store.record(node);
        return HeightRange{store.info().height_m(record.min_quanta),
                           store.info().height_m(record.max_quanta)};
    }
    Result<CellHeights> cells(NodeId node) override {
        const auto found = tile(node);
        if (!found) return found.error();
        const HeightsTile& heights = **found;
        const std::size_t corner = heights.at(0, 0);
        return CellHeights{.stride = heights.stride(),
                           .quanta = heights.quanta.data() + corner,
                           .valid = heights.all_valid ? nullptr : heights.sample_valid.data() + corner,
                           .offset_m = store.info().height_offset_m,
                           .quantum_m = store.info().quantum_m};
    }

    Result<RayHit> follow(const glm::dvec3& origin_m, const glm::dvec3& direction, double length_m,
                          RayWalk::Ends ends) {
        const auto unit = unit_of(origin_m, direction);
        if (!unit) return unit.error();
        const NearRay near = near_ray(store.info(), top_m, origin_m, *unit, length_m);
        const auto met = RayWalk(*this, grid(), ends).first(near.ray, near.reach);
        if (!met) return met.error();
        if (!*met) return RayHit{};
        const glm::dvec3 place = near.ray.at(**met);
        return RayHit{true, near.skipped_m + **met, {store.info().world(place.x, place.y), place.z}};
    }
};

SurfaceQuery::SurfaceQuery(const io::Store& store, const SurfaceQueryOptions& options)
    : state_(std::make_unique<State>(store, options)) {}
SurfaceQuery::~SurfaceQuery() = default;
SurfaceQuery::SurfaceQuery(SurfaceQuery&&) noexcept = default;
SurfaceQuery& SurfaceQuery::operator=(SurfaceQuery&&) noexcept = default;

Result<SurfaceHeight> SurfaceQuery::height(double east_m, double north_m) {
    const glm::dvec2 place = state_->store.info().lattice(east_m, north_m);
    return height_at(place.x, place.y);
}

Result<SurfaceHeight> SurfaceQuery::height_at(double column, double row) {
    const io::Grid& grid = state_->grid();
    column = snapped(column);
    row = snapped(row);
    // Written so that what is not a number is outside.
    if (!(column >= 0.0 && row >= 0.0 && column <= static_cast<double>(grid.width() - 1) &&
          row <= static_cast<double>(grid.height() - 1)))
        return SurfaceHeight{SurfaceHeight::Kind::outside, 0.0};
    const auto x = static_cast<std::int64_t>(column), y = static_cast<std::int64_t>(row);
    const double u = column - static_cast<double>(x), v = row - static_cast<double>(y);
    const double weights[4] = {(1.0 - u) * (1.0 - v), u * (1.0 - v), (1.0 - u) * v, u * v};
    double quanta = 0.0;
    for (int corner = 0; corner < 4; ++corner) {
        if (weights[corner] == 0.0) continue;
        const auto sample = state_->sample(x + (corner & 1), y + (corner >> 1));
        if (!sample) return sample.error();
        if (!sample->has_value()) return SurfaceHeight{SurfaceHeight::Kind::nodata, 0.0};
        quanta += weights[corner] * **sample;
    }
    if (state_->detail_levels > 0) {
        const auto made = state_->detail_quanta(column, row);
        if (!made) return made.error();
        if (made->has_value()) quanta = **made;
    }
    return SurfaceHeight{SurfaceHeight::Kind::ground, state_->store.info().height_m(quanta)};
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
