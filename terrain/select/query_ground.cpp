#include "ridgeline/select/query_ground.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "ridgeline/base/contract.h"
#include "ridgeline/detail/detail_tile.h"

namespace ridgeline::select {
namespace {

using detail::DetailTile;
using detail::UnitRange;
using io::HeightsTile;
using io::NodeId;

// Every octave that is asked for, also of terrains whose finest lattice no walk could draw.
detail::FinerGround foretold(const io::TerrainInfo& info, int octaves) {
    RIDGELINE_CHECK(octaves == 0 ||
                    (info.detail && octaves <= static_cast<int>(info.detail->octaves.size())));
    detail::FinerGround ground{.shift = detail::detail_shift(info), .gains = {}};
    if (octaves > 0)
        ground.gains.assign(info.detail->octaves.begin(), info.detail->octaves.begin() + octaves);
    return ground;
}

bool is_valid(const HeightsTile& tile, int column, int row) {
    return tile.all_valid || tile.sample_valid[tile.at(column, row)] != 0;
}

// Which nodes along an axis hold a place, in cells of a node's side: two where it lies on their border.
std::pair<std::int32_t, std::int32_t> nodes_about(double place, int quads) {
    return {static_cast<std::int32_t>(std::floor(place / quads)),
            static_cast<std::int32_t>(std::ceil(place / quads)) - 1};
}

// At a place in the node's own cells.
double bilinear(const DetailTile& tile, double x, double y) {
    const int column = std::min(static_cast<int>(x), tile.quads - 1);
    const int row = std::min(static_cast<int>(y), tile.quads - 1);
    const auto along = [&](int south) {
        const double west = tile.height(column, row + south), east = tile.height(column + 1, row + south);
        return west + (x - column) * (east - west);
    };
    return along(0) + (y - row) * (along(1) - along(0));
}

}  // namespace

QueryGround::QueryGround(const io::Store& store, int detail_levels, std::size_t cached_tiles)
    : store_(store),
      tiles_(cached_tiles),
      made_(foretold(store.info(), detail_levels), store.grid().finest(), cached_tiles) {
    for (std::int64_t i = 0; i < grid().first(1); ++i)
        if (const auto root = source_range(grid().node_at(i)))
            top_m_ = std::max(top_m_, range_of(*root).most_m + 1.0);
}

bool QueryGround::exists(NodeId node) const {
    if (node.level <= grid().finest()) return grid().contains(node);
    const int octave = node.level - grid().finest();
    const auto begins_within = [&](std::int64_t at, std::int64_t samples) {
        return at * grid().quads() < (samples - 1) << octave;
    };
    return begins_within(node.x, grid().width()) && begins_within(node.y, grid().height());
}

NodeId QueryGround::source_of(NodeId node) const {
    const int octave = node.level - grid().finest();
    return {grid().finest(), node.x >> octave, node.y >> octave};
}

double QueryGround::height_m_of(double units) const {
    return info().height_m(std::ldexp(units, -made_.ground().shift));
}

HeightRange QueryGround::range_of(const UnitRange& units) const {
    return {height_m_of(static_cast<double>(units.least)), height_m_of(static_cast<double>(units.most))};
}

// Null where the node has no data.
Result<const HeightsTile*> QueryGround::source_tile(NodeId node) {
    if (!store_.record(node).has_data()) return static_cast<const HeightsTile*>(nullptr);
    const std::int64_t key = grid().linear(node);
    if (const HeightsTile* found = tiles_.find(key)) return found;
    HeightsTile& made = tiles_.make(key);
    if (const auto read = store_.read_heights(node, bytes_, made); !read) {
        tiles_.forget(key);
        return read.error();
    }
    return static_cast<const HeightsTile*>(&made);
}

Result<bool> QueryGround::fill_root(NodeId node, DetailTile& root) {
    const auto source = source_tile(node);
    if (!source) return source.error();
    if (*source == nullptr) return false;
    detail::make_root(**source, node, made_.ground().shift, root);
    return true;
}

// A valid sample's. On a border any of the nodes that share it may answer: one alone may have data.
Result<std::optional<double>> QueryGround::sample_quanta(std::int64_t column, std::int64_t row) {
    const int quads = grid().quads(), level = grid().finest();
    for (const std::int64_t y : {row / quads, (row - 1) / quads})
        for (const std::int64_t x : {column / quads, (column - 1) / quads}) {
            const NodeId node{level, static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)};
            if (!grid().contains(node)) continue;
            const auto found = source_tile(node);
            if (!found) return found.error();
            if (*found == nullptr) continue;
            const int at_x = static_cast<int>(column - x * quads), at_y = static_cast<int>(row - y * quads);
            if (!is_valid(**found, at_x, at_y)) return std::optional<double>();
            return std::optional(static_cast<double>((*found)->quanta[(*found)->at(at_x, at_y)]));
        }
    return std::optional<double>();
}

Result<std::optional<double>> QueryGround::source_quanta(double column, double row) {
    const auto x = static_cast<std::int64_t>(column), y = static_cast<std::int64_t>(row);
    const double u = column - static_cast<double>(x), v = row - static_cast<double>(y);
    const double weights[4] = {(1.0 - u) * (1.0 - v), u * (1.0 - v), (1.0 - u) * v, u * v};
    double quanta = 0.0;
    for (int corner = 0; corner < 4; ++corner) {
        if (weights[corner] == 0.0) continue;
        const auto sample = sample_quanta(x + (corner & 1), y + (corner >> 1));
        if (!sample || !sample->has_value()) return sample;
        quanta += weights[corner] * **sample;
    }
    return std::optional(quanta);
}

// As sample_quanta: any of the nodes that share a border.
Result<std::optional<double>> QueryGround::made_units(double column, double row) {
    const int quads = grid().quads();
    const double x = std::ldexp(column, octaves()), y = std::ldexp(row, octaves());
    const auto columns = nodes_about(x, quads), rows = nodes_about(y, quads);
    for (const std::int32_t at_y : {rows.first, rows.second})
        for (const std::int32_t at_x : {columns.first, columns.second}) {
            const NodeId node{deepest_level(), at_x, at_y};
            if (at_x < 0 || at_y < 0 || !exists(node)) continue;
            const auto made = made_.tile(node, *this);
            if (!made) return made.error();
            if (*made == nullptr) continue;
            return std::optional(bilinear(**made, x - static_cast<double>(at_x) * quads,
                                          y - static_cast<double>(at_y) * quads));
        }
    return std::optional<double>();
}

Result<std::optional<double>> QueryGround::height_m(double column, double row) {
    const auto quanta = source_quanta(column, row);
    if (!quanta || !quanta->has_value()) return quanta;
    if (octaves() == 0) return std::optional(info().height_m(**quanta));
    const auto made = made_units(column, row);
    if (!made || !made->has_value()) return made;
    return std::optional(height_m_of(**made));
}

// Made ground follows what lies about a node too, and fill where there are holes, of which records say nothing.
std::optional<UnitRange> QueryGround::source_range(NodeId node) const {
    constexpr std::int64_t kAnyHeight = std::int64_t{1} << 32;
    if (!exists(node) || !store_.record(node).has_data()) return {};
    if (octaves() > 0 && info().invalid_samples > 0) return UnitRange{-kAnyHeight, kAnyHeight};
    UnitRange range{kAnyHeight, -kAnyHeight};
    const std::int32_t reach = octaves() > 0 ? 1 : 0;
    for (std::int32_t y = node.y - reach; y <= node.y + reach; ++y)
        for (std::int32_t x = node.x - reach; x <= node.x + reach; ++x) {
            const NodeId near{node.level, x, y};
            if (!grid().contains(near) || !store_.record(near).has_data()) continue;
            const std::int64_t unit = std::int64_t{1} << made_.ground().shift;
            range.least = std::min(range.least, store_.record(near).min_quanta * unit);
            range.most = std::max(range.most, store_.record(near).max_quanta * unit);
        }
    return detail::made_range(range, made_.ground().gains);
}

Result<std::optional<HeightRange>> QueryGround::range(NodeId node) {
    if (!exists(node)) return std::optional<HeightRange>();
    if (node.level <= grid().finest()) {
        const auto range = source_range(node);
        return range ? std::optional(range_of(*range)) : std::nullopt;
    }
    const auto parent = made_.tile(node.parent(), *this);
    if (!parent) return parent.error();
    if (*parent == nullptr) return std::optional<HeightRange>();
    const auto below = std::span(made_.ground().gains).subspan(static_cast<std::size_t>((*parent)->octave));
    return std::optional(range_of(detail::made_range(**parent, node.quarter(), below)));
}

Result<CellHeights> QueryGround::cells(NodeId node) {
    const auto source = source_tile(source_of(node));
    if (!source) return source.error();
    if (octaves() == 0) return source_cells(**source);
    const auto made = made_.tile(node, *this);
    if (!made) return made.error();
    const std::size_t corner = (*source)->at(0, 0);
    return CellHeights{.stride = (*source)->stride(),
                       .quanta = (*made)->heights.data() + corner,
                       .valid = made_valid(**source, **made),
                       .offset_m = info().height_offset_m,
                       .quantum_m = std::ldexp(info().quantum_m, -made_.ground().shift)};
}

CellHeights QueryGround::source_cells(const HeightsTile& tile) const {
    const std::size_t corner = tile.at(0, 0);
    return {.stride = tile.stride(),
            .quanta = tile.quanta.data() + corner,
            .valid = tile.all_valid ? nullptr : tile.sample_valid.data() + corner,
            .offset_m = info().height_offset_m,
            .quantum_m = info().quantum_m};
}

// Of a made tile's samples: those between valid ones of the source. Null where all are.
const std::uint8_t* QueryGround::made_valid(const HeightsTile& source, const DetailTile& made) {
    if (source.all_valid) return nullptr;
    const int octave = made.octave, quads = source.quads, rate = 1 << octave;
    const glm::ivec2 corner(quads * (made.node.x & (rate - 1)), quads * (made.node.y & (rate - 1)));
    valid_.assign(source.quanta.size(), 0);
    for (int row = 0; row <= quads; ++row)
        for (int column = 0; column <= quads; ++column) {
            const glm::ivec2 at = corner + glm::ivec2(column, row);
            const glm::ivec2 first = at >> octave, last = (at + rate - 1) >> octave;
            valid_[source.at(column, row)] =
                is_valid(source, first.x, first.y) && is_valid(source, last.x, first.y) &&
                        is_valid(source, first.x, last.y) && is_valid(source, last.x, last.y)
                    ? 1
                    : 0;
        }
    return valid_.data() + source.at(0, 0);
}

}  // namespace ridgeline::select
