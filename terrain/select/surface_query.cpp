// A ray is walked in lattice coordinates, where patches are unit squares: down the quadtree nearest node
// first, with the records' height bounds as boxes, then from cell to cell (Amanatides and Woo, "A fast voxel
// traversal algorithm for ray tracing", 1987). Within a cell the surface is bilinear, so the ray meets it at
// a root of a quadratic.
#include "ridgeline/select/surface_query.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "ridgeline/base/contract.h"
#include "ridgeline/detail/detail_tile.h"
#include "ridgeline/select/least_recent_cache.h"

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

struct Interval {
    double from = 0.0, to = 0.0;
    bool empty() const { return !(from <= to); }
};

// Cuts the part of an interval on which origin + t * slope lies within [low, high].
Interval clipped(Interval t, double origin, double slope, double low, double high) {
    if (slope == 0.0) return origin >= low && origin <= high ? t : Interval{1.0, 0.0};
    const double a = (low - origin) / slope, b = (high - origin) / slope;
    return {std::max(t.from, std::min(a, b)), std::min(t.to, std::max(a, b))};
}

// A ray in lattice coordinates: columns, rows and metres of height per metre of the ray.
struct LatticeRay {
    glm::dvec3 origin{0.0};
    glm::dvec3 slope{0.0};
    glm::dvec3 at(double t) const { return origin + t * slope; }
};

// The least root of c0 + c1 s + c2 s^2 in [0, length], grown by what rounding may take.
std::optional<double> first_root(double c0, double c1, double c2, double length) {
    const double slack = 1e-9 * (1.0 + length);
    const auto inside = [&](double s) { return s >= -slack && s <= length + slack; };
    if (c0 == 0.0) return 0.0;
    std::array<double, 2> roots{};
    const double discriminant = c1 * c1 - 4.0 * c2 * c0;
    if (discriminant < 0.0) return {};
    // The form that subtracts nothing alike; c2 = 0 leaves one root.
    const double q = -0.5 * (c1 + std::copysign(std::sqrt(discriminant), c1));
    if (q == 0.0) return {};
    roots = {c0 / q, c2 != 0.0 ? q / c2 : c0 / q};
    if (roots[0] > roots[1]) std::swap(roots[0], roots[1]);
    for (const double root : roots)
        if (inside(root)) return std::clamp(root, 0.0, length);
    return {};
}

// Where the ray meets the bilinear patch between four corner heights (north-west, north-east, south-west,
// south-east) of the cell at (column, row), along [t.from, t.to].
std::optional<double> meet_patch(const LatticeRay& ray, double column, double row,
                                 const std::array<double, 4>& h, Interval t) {
    const glm::dvec3 p = ray.at(t.from);
    const double u = p.x - column, v = p.y - row;
    const double hu = h[1] - h[0], hv = h[2] - h[0], huv = h[0] - h[1] - h[2] + h[3];
    const double du = ray.slope.x, dv = ray.slope.y;
    const double c0 = p.z - (h[0] + hu * u + hv * v + huv * u * v);
    const double c1 = ray.slope.z - (hu * du + hv * dv + huv * (u * dv + v * du));
    const double c2 = -huv * du * dv;
    const auto root = first_root(c0, c1, c2, t.to - t.from);
    if (!root) return {};
    return t.from + *root;
}

}  // namespace

struct SurfaceQuery::State {
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
    }

    const io::Store& store;
    const int detail_levels;
    const int detail_shift;
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

    Result<std::optional<double>> meet_node(const LatticeRay& ray, NodeId node, Interval t);
    Result<std::optional<double>> meet_children(const LatticeRay& ray, NodeId node, Interval t);
    std::optional<double> meet_tile(const LatticeRay& ray, NodeId node, const HeightsTile& heights,
                                    Interval t) const;
    std::optional<double> meet_cell(const LatticeRay& ray, NodeId node, const HeightsTile& heights,
                                    int column, int row, Interval t) const;
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

Result<std::optional<RayHit>> SurfaceQuery::ray_cast(const glm::dvec3& origin_m, const glm::dvec3& direction,
                                                     double max_distance_m) {
    RIDGELINE_CHECK(glm::dot(direction, direction) > 0.0);
    const io::TerrainInfo& info = state_->store.info();
    const glm::dvec3 unit = glm::normalize(direction);
    const glm::dvec2 place = info.lattice(origin_m.x, origin_m.y);
    const LatticeRay ray{{place, origin_m.z},
                         {unit.x / info.spacing_x_m, -unit.y / info.spacing_y_m, unit.z}};
    std::optional<double> nearest;
    Interval reach{0.0, max_distance_m};
    for (std::int64_t i = 0; i < state_->grid().first(1); ++i) {
        const auto hit = state_->meet_node(ray, state_->grid().node_at(i), reach);
        if (!hit) return hit.error();
        if (*hit) reach.to = *(nearest = *hit);
    }
    if (!nearest) return std::optional<RayHit>();
    return std::optional(RayHit{*nearest, origin_m + *nearest * unit});
}

Result<std::optional<double>> SurfaceQuery::State::meet_node(const LatticeRay& ray, NodeId node, Interval t) {
    const io::NodeRecord& record = store.record(node);
    if (!record.has_data()) return std::optional<double>();
    const io::LatticePoint origin = grid().origin(node);
    const std::int64_t extent = grid().extent(node.level);
    const auto clip = [&](double from, double slope, std::int64_t low, std::int64_t count) {
        t = clipped(t, from, slope, static_cast<double>(low),
                    static_cast<double>(std::min(low + extent, count - 1)));
    };
    clip(ray.origin.x, ray.slope.x, origin.x, grid().width());
    clip(ray.origin.y, ray.slope.y, origin.y, grid().height());
    const Interval in_heights =
        clipped(t, ray.origin.z, ray.slope.z, store.info().height_m(record.min_quanta),
                store.info().height_m(record.max_quanta));
    if (in_heights.empty()) return std::optional<double>();
    if (node.level < grid().finest()) return meet_children(ray, node, in_heights);
    const auto heights = tile(node);
    if (!heights) return heights.error();
    return *heights == nullptr ? std::optional<double>() : meet_tile(ray, node, **heights, in_heights);
}

// Nearest child first, by the quadrant that the ray enters and the way it runs.
Result<std::optional<double>> SurfaceQuery::State::meet_children(const LatticeRay& ray, NodeId node,
                                                                 Interval t) {
    const int first = (ray.slope.x < 0.0 ? 1 : 0) + (ray.slope.y < 0.0 ? 2 : 0);
    for (const int turn : {0, 1, 2, 3}) {
        const NodeId child = node.child(first ^ turn);
        if (!grid().contains(child)) continue;
        auto hit = meet_node(ray, child, t);
        if (!hit || *hit) return hit;
    }
    return std::optional<double>();
}

std::optional<double> SurfaceQuery::State::meet_tile(const LatticeRay& ray, NodeId node,
                                                     const HeightsTile& heights, Interval t) const {
    const io::LatticePoint origin = grid().origin(node);
    const LatticeRay local{ray.origin - glm::dvec3(origin.x, origin.y, 0.0), ray.slope};
    const glm::dvec3 start = local.at(t.from);
    const auto cell_of = [&](double coordinate) {
        return std::clamp(static_cast<int>(std::floor(coordinate)), 0, grid().quads() - 1);
    };
    int cell[2] = {cell_of(start.x), cell_of(start.y)};
    const double from[2] = {local.origin.x, local.origin.y}, slope[2] = {local.slope.x, local.slope.y};
    const auto leaves_at = [&](int axis) {
        if (slope[axis] == 0.0) return std::numeric_limits<double>::infinity();
        return (cell[axis] + (slope[axis] > 0.0 ? 1 : 0) - from[axis]) / slope[axis];
    };
    for (double now = t.from; now <= t.to;) {
        const double x = leaves_at(0), y = leaves_at(1);
        const double next = std::max(std::min({x, y, t.to}), now);
        if (const auto hit = meet_cell(local, node, heights, cell[0], cell[1], {now, next})) return hit;
        const int axis = x <= y ? 0 : 1;
        if (std::min(x, y) >= t.to) break;
        cell[axis] += slope[axis] > 0.0 ? 1 : -1;
        if (cell[axis] < 0 || cell[axis] >= grid().quads()) break;
        now = next;
    }
    return {};
}

std::optional<double> SurfaceQuery::State::meet_cell(const LatticeRay& ray, NodeId node,
                                                     const HeightsTile& heights, int column, int row,
                                                     Interval t) const {
    const io::LatticePoint origin = grid().origin(node);
    if (origin.x + column >= grid().width() - 1 || origin.y + row >= grid().height() - 1) return {};
    std::array<double, 4> corners{};
    for (int corner = 0; corner < 4; ++corner) {
        const std::size_t at = heights.at(column + (corner & 1), row + (corner >> 1));
        if (!heights.all_valid && heights.sample_valid[at] == 0) return {};
        corners[static_cast<std::size_t>(corner)] = store.info().height_m(heights.quanta[at]);
    }
    return meet_patch(ray, column, row, corners, t);
}

}  // namespace ridgeline::select
