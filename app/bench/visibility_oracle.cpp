// Literature: for a height field, what hides what is decided in each vertical plane through the eye by itself
// (horizon paper, 3.2); a plane's edges of triangles are straight lines in (across / along, up / along).
//
// How we differ from a march along rays. Nothing need be put in order within a quarter of a node: its
// steepest place in a slice is seen exactly where it stands above all nearer quarters. Quarters are squares
// of a quadtree, which every ray from the eye meets in the tree's order from front to back.
//
// Holes. Rays that pass above the ground before a hole may get through it, and under the ground behind. There
// the horizon rises no more, and what stands above it may or may not be seen; what does not is hidden all the
// same.
#include "ridgeline/app/bench/visibility_oracle.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "ridgeline/select/drawn_surface.h"

namespace ridgeline::app {
namespace {

using io::NodeId;
using select::DrawEntry;

constexpr double kNothing = std::numeric_limits<double>::infinity();
// Edges are cut off this near to the eye's vertical: far below any picture there.
constexpr double kNearest_m = 0.001;
// Less than this above the horizon is rounding: a ten-thousandth of a pixel.
constexpr double kRounding = 1e-7;

}  // namespace

VisibilityOracle::VisibilityOracle(const io::Grid& grid, std::span<const io::NodeRecord> records,
                                   const select::GroundSource& chunks, const OracleOptions& options)
    : grid_(grid),
      records_(records),
      chunks_(chunks),
      has_holes_(!std::ranges::all_of(records, &io::NodeRecord::has_data)),
      slices_(static_cast<std::size_t>(options.slices)) {}

std::span<const JudgedQuarter> VisibilityOracle::judge(const select::EyeFrame& eye,
                                                       std::span<const DrawEntry> draws,
                                                       const LevelView& view) {
    eye_ = eye;
    view_ = view;
    placed_ = nullptr;
    judged_.clear();
    std::ranges::fill(slices_, Slice{-kNothing, kNothing, -kNothing, false});
    collect(draws);
    for (const Item& item : items_) {
        if (item.entry == nullptr) {
            cut_hole(item.square);
            open_touched();
        } else {
            judged_.push_back(look(item, cut_quarter(item)));
        }
        forget_touched();
    }
    return judged_;
}

// --- front to back

void VisibilityOracle::collect(std::span<const DrawEntry> draws) {
    items_.clear();
    drawn_.clear();
    for (const DrawEntry& entry : draws) {
        for (int q = 0; q < io::kQuarters; ++q)
            if ((entry.quarters >> q & 1) != 0)
                items_.push_back({key_of(entry.node.child(q)), entry.node.child(q), &entry, q});
        if (has_holes_) drawn_.insert(grid_.linear(entry.node));
    }
    for (std::int64_t root = 0; has_holes_ && root < grid_.first(1); ++root)
        collect_holes(grid_.node_at(root));
    std::ranges::sort(items_, {}, &Item::key);
}

// Below what draws nothing itself, in view or not.
void VisibilityOracle::collect_holes(NodeId node) {
    if (!grid_.contains(node)) return;
    const std::int64_t place = grid_.linear(node);
    if (!records_[static_cast<std::size_t>(place)].has_data())
        items_.push_back({key_of(node), node, nullptr, 0});
    else if (!drawn_.contains(place))
        for (int q = 0; q < io::kQuarters; ++q) collect_holes(node.child(q));
}

// Roots by the steps that a ray takes to them; below them two bits a level, the nearest quarter first and its
// opposite last.
std::uint64_t VisibilityOracle::key_of(NodeId square) const {
    const auto root_of = [&](int cell) { return static_cast<int>(cell / grid_.extent(0)); };
    const NodeId root{0, square.x >> square.level, square.y >> square.level};
    auto key = static_cast<std::uint64_t>(std::abs(root.x - root_of(eye_.cell.x)) +
                                          std::abs(root.y - root_of(eye_.cell.y)));
    for (int level = 1; level <= grid_.levels(); ++level) {
        key <<= 2;
        if (level > square.level) continue;
        const int up = square.level - level;
        const std::int64_t side = grid_.extent(level - 1) / 2;
        const int x = square.x >> up, y = square.y >> up;
        // Whether the eye is in the eastern, the southern half of the node that these are the quarters of.
        const int east = eye_.cell.x >= side * (x | 1) ? 1 : 0, south = eye_.cell.y >= side * (y | 1) ? 1 : 0;
        key |= static_cast<std::uint64_t>(((x & 1) ^ east) | ((y & 1) ^ south) << 1);
    }
    return key;
}

// --- cutting

VisibilityOracle::Point VisibilityOracle::turned(const glm::dvec3& from_eye_m) const {
    const glm::dvec2& ahead = view_.heading;
    return {from_eye_m.x * ahead.x + from_eye_m.y * ahead.y, from_eye_m.x * ahead.y - from_eye_m.y * ahead.x,
            from_eye_m.z};
}

void VisibilityOracle::cut_hole(NodeId square) {
    const std::int64_t side = grid_.extent(square.level);
    const auto corner = [&](int x, int y) {
        const auto column = static_cast<double>((square.x + x) * side - eye_.cell.x),
                   row = static_cast<double>((square.y + y) * side - eye_.cell.y);
        const glm::dvec2 rest(eye_.cell_rest), spacing_m(eye_.spacing_m);
        return turned({(column - rest.x) * spacing_m.x, (rest.y - row) * spacing_m.y, 0.0});
    };
    cut_edge(corner(0, 0), corner(1, 0));
    cut_edge(corner(1, 0), corner(1, 1));
    cut_edge(corner(1, 1), corner(0, 1));
    cut_edge(corner(0, 1), corner(0, 0));
}

// Returns how many triangles there are.
std::uint32_t VisibilityOracle::cut_quarter(const Item& item) {
    if (placed_ != item.entry) place_vertices(*item.entry);
    const io::ChunkView chunk = chunks_.chunk(item.entry->index);
    const auto indices = chunk.indices();
    std::uint32_t triangles = 0;
    for (const io::IndexRange& range : select::quarter_ranges(chunk.ranges(), *item.entry, item.quarter)) {
        triangles += range.count / 3;
        for (std::uint32_t i = range.first; i < range.first + range.count; i += 3) {
            const Point &a = vertices_[indices[i]], &b = vertices_[indices[i + 1]],
                        &c = vertices_[indices[i + 2]];
            cut_edge(a, b);
            cut_edge(b, c);
            cut_edge(c, a);
        }
    }
    return triangles;
}

void VisibilityOracle::place_vertices(const DrawEntry& entry) {
    placed_ = &entry;
    vertices_.clear();
    for (const io::ChunkVertex& vertex : chunks_.chunk(entry.index).vertices())
        vertices_.push_back(
            turned(glm::dvec3(select::drawn_vertex(eye_, entry.origin, entry.morph, vertex).position_m)));
}

void VisibilityOracle::cut_edge(const Point& a, const Point& b) {
    if (a.along < kNearest_m && b.along < kNearest_m) return;
    const auto seen = [](const Point& from, const Point& to) {
        if (from.along >= kNearest_m) return glm::dvec2(from.right, from.up) / from.along;
        const double t = (kNearest_m - from.along) / (to.along - from.along);
        return glm::dvec2(from.right + t * (to.right - from.right), from.up + t * (to.up - from.up)) /
               kNearest_m;
    };
    glm::dvec2 left = seen(a, b), right = seen(b, a);
    // So that both sides of an edge come to the same.
    if (right.x < left.x) std::swap(left, right);
    const double slices_per_tangent = static_cast<double>(slices_.size()) / (2.0 * view_.half_tangents.x);
    const auto place = [&](double across) {
        return std::clamp((across + view_.half_tangents.x) * slices_per_tangent - 0.5, -1.0,
                          static_cast<double>(slices_.size()));
    };
    const int first = std::max(static_cast<int>(std::ceil(place(left.x))), 0);
    const int last =
        std::min(static_cast<int>(std::floor(place(right.x))), static_cast<int>(slices_.size()) - 1);
    const double rise = right.x > left.x ? (right.y - left.y) / (right.x - left.x) : 0.0;
    for (int slice = first; slice <= last; ++slice) {
        const double across = (slice + 0.5) / slices_per_tangent - view_.half_tangents.x;
        take(slice, left.y + (across - left.x) * rise);
        if (right.x == left.x) take(slice, right.y);
    }
}

void VisibilityOracle::take(int slice, double slope) {
    Slice& at = slices_[static_cast<std::size_t>(slice)];
    at.least = std::min(at.least, slope);
    at.most = std::max(at.most, slope);
    if (first_touched_ > last_touched_) first_touched_ = last_touched_ = slice;
    first_touched_ = std::min(first_touched_, slice);
    last_touched_ = std::max(last_touched_, slice);
}

// --- what is seen

JudgedQuarter VisibilityOracle::look(const Item& item, std::uint32_t triangles) {
    const double edge = view_.half_tangents.y;
    const bool holed = records_[item.entry->index].has_mask();
    JudgedQuarter judged{item.entry, item.quarter, Sight::outside, triangles};
    for (int i = first_touched_; i <= last_touched_; ++i) {
        Slice& slice = slices_[static_cast<std::size_t>(i)];
        const bool touched = slice.least <= slice.most;
        if (!touched) continue;
        const double from = std::max(slice.horizon, -edge), to = std::min(slice.most, edge);
        const bool in_picture = slice.most >= -edge && slice.least <= edge;
        const bool above = in_picture && to > from + kRounding;
        if (in_picture && judged.sight == Sight::outside) judged.sight = Sight::hidden;
        if (above && (holed || slice.open)) {
            if (judged.sight == Sight::hidden) judged.sight = Sight::unknown;
        } else if (above && to - from > 2.0 * judged.clearance) {
            judged.sight = Sight::seen;
            judged.clearance = 0.5 * (to - from);
            const double across = (i + 0.5) / static_cast<double>(slices_.size()) * 2.0 - 1.0;
            judged.ray = {across * view_.half_tangents.x, 0.5 * (from + to)};
        }
        slice.open = slice.open || (holed && slice.most > slice.horizon);
        if (!slice.open) slice.horizon = std::max(slice.horizon, slice.most);
    }
    return judged;
}

void VisibilityOracle::open_touched() {
    for (int i = first_touched_; i <= last_touched_; ++i) {
        Slice& slice = slices_[static_cast<std::size_t>(i)];
        slice.open = slice.open || slice.least <= slice.most;
    }
}

void VisibilityOracle::forget_touched() {
    for (int i = first_touched_; i <= last_touched_; ++i) {
        slices_[static_cast<std::size_t>(i)].least = kNothing;
        slices_[static_cast<std::size_t>(i)].most = -kNothing;
    }
    first_touched_ = 0;
    last_touched_ = -1;
}

}  // namespace ridgeline::app
