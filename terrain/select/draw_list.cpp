// Front to back by the eye's quadrant: of a node's four children the one in which the eye's place falls comes
// first, its diagonal opposite last; a node that draws some quarters itself takes the place of the nearest of
// them.
#include "ridgeline/select/draw_list.h"

#include <algorithm>
#include <bit>

#include "ridgeline/select/morph_ranges.h"

namespace ridgeline::select {
namespace {

using io::NodeId;
using io::Side;

// The quarter of the neighbour beyond `side` that lies across the node's half.
constexpr int quarter_across(Side side, int half) {
    switch (side) {
        case Side::west:
            return 1 + 2 * half;
        case Side::east:
            return 2 * half;
        case Side::north:
            return 2 + half;
        default:
            return half;
    }
}

// The quarter of the same node beyond an inner side.
constexpr int quarter_beside(int quarter, Side side) {
    return quarter ^ (side == Side::west || side == Side::east ? 1 : 2);
}

MorphSpan span_of(const TerrainFrame& frame, const FrameTree& tree, Residency residency, const Visit& v) {
    MorphSpan span;
    const double split_m = frame.split_m(v), distance_m = frame.distance_m(v),
                 diagonal_m = frame.diagonal_m(v);
    span.end_m = frame.merge_m(v);
    span.reach_m = split_m + diagonal_m;
    span.far_m = distance_m + diagonal_m;
    if (split_m > 0.0 && span.end_m > split_m)
        span.rest = std::clamp((distance_m - split_m) / (span.end_m - split_m), 0.0, 1.0);
    if (tree.has(v.index, FrameTree::kResident)) span.fade = residency[v.index].fade;
    return span;
}

bool finer_beyond(const MorphNeighbours& neighbours, int quarter, Side side) {
    if (io::inner_line(quarter, side) >= 0)
        return (neighbours.quarters_of_children >> quarter_beside(quarter, side) & 1u) != 0;
    const auto half = static_cast<std::size_t>(io::half_of(quarter, side));
    return neighbours.beyond[static_cast<std::size_t>(io::index(side))][half] == Beyond::finer;
}

glm::ivec2 relative_origin(const io::Grid& grid, NodeId node, const EyeFrame& eye) {
    const io::LatticePoint origin = grid.origin(node);
    return {static_cast<int>(origin.x - eye.cell.x), static_cast<int>(origin.y - eye.cell.y)};
}

constexpr std::size_t kUsualEntries = 4096;

}  // namespace

DrawList::DrawList(const TerrainFrame& frame, const FrameTree& tree)
    : frame_(frame), tree_(tree), drawn_(frame, tree) {
    entries_.reserve(kUsualEntries);
}

void DrawList::build(const Frustum& visible, const EyeFrame& eye, Residency residency,
                     std::span<const Visit> roots, std::span<const std::uint8_t> hidden_quarters) {
    visible_ = &visible;
    eye_ = eye;
    residency_ = residency;
    hidden_quarters_ = hidden_quarters;
    entries_.clear();
    triangles_ = 0;
    finest_level_ = 0;
    for (const Visit& root : roots) walk(root);
}

void DrawList::walk(const Visit& v) {
    if (!tree_.has(v.index, FrameTree::kInView | FrameTree::kResident)) return;
    const int nearest = drawn_.nearest_quarter(v.node, eye_.cell);
    const unsigned hidden = hidden_quarters_.empty() ? 0u : hidden_quarters_[v.index];
    unsigned own_quarters = 0;
    std::size_t place = 0;
    for (const int turn : DrawnTree::kTurns) {
        const int quarter = nearest ^ turn;
        if (!frame_.quarter_exists(v.node, quarter)) continue;
        if (drawn_.child_drawn(v.node, quarter)) {
            walk(visit(frame_.grid(), v.node.child(quarter)));
        } else if ((hidden >> quarter & 1u) == 0 && drawn_.quarter_in_view(v, quarter, *visible_)) {
            if (own_quarters == 0) {
                place = entries_.size();
                entries_.emplace_back();
            }
            own_quarters |= 1u << quarter;
        }
    }
    if (own_quarters == 0) return;
    entries_[place] = entry(v, own_quarters, eye_, residency_);
    triangles_ +=
        frame_.record(v.index).triangle_count * static_cast<unsigned>(std::popcount(own_quarters)) / 4;
    finest_level_ = std::max(finest_level_, v.node.level);
}

DrawEntry DrawList::entry(const Visit& v, unsigned quarters, const EyeFrame& eye, Residency residency) const {
    const MorphNeighbours neighbours = neighbours_of(v, residency);
    DrawEntry entry;
    entry.node = v.node;
    entry.index = v.index;
    entry.quarters = static_cast<std::uint8_t>(quarters);
    entry.origin = relative_origin(frame_.grid(), v.node, eye);
    entry.morph = morph_table(span_of(frame_, tree_, residency, v), neighbours);
    for (int q = 0; q < io::kQuarters; ++q) {
        if ((quarters >> q & 1u) == 0) continue;
        for (int s = 0; s < io::kSides; ++s)
            entry.sides[static_cast<std::size_t>(q)][static_cast<std::size_t>(s)] =
                finer_beyond(neighbours, q, static_cast<Side>(s)) ? SideUse::fan : SideUse::plain;
    }
    return entry;
}

MorphNeighbours DrawList::neighbours_of(const Visit& v, Residency residency) const {
    MorphNeighbours neighbours;
    for (int q = 0; q < io::kQuarters; ++q)
        if (drawn_.child_drawn(v.node, q)) neighbours.quarters_of_children |= 1u << q;
    for (int s = 0; s < io::kSides; ++s) {
        const auto side = static_cast<Side>(s);
        const NodeId node = io::neighbour(v.node, side);
        if (!frame_.grid().contains(node)) continue;
        auto& beyond = neighbours.beyond[static_cast<std::size_t>(s)];
        const Visit other = visit(frame_.grid(), node);
        if (!tree_.has(other.index, FrameTree::kDrawn)) {
            beyond.fill(Beyond::coarser);
            continue;
        }
        neighbours.span[static_cast<std::size_t>(s)] = span_of(frame_, tree_, residency, other);
        for (int half = 0; half < 2; ++half)
            beyond[static_cast<std::size_t>(half)] =
                drawn_.child_drawn(node, quarter_across(side, half)) ? Beyond::finer : Beyond::same;
    }
    return neighbours;
}

}  // namespace ridgeline::select
