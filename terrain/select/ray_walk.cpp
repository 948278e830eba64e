// Down the quadtree in the order in which the ray passes the nodes, with their height bounds as boxes, then
// from cell to cell (Amanatides and Woo, "A fast voxel traversal algorithm for ray tracing", 1987). Within a
// cell the surface is bilinear, so the height over it is a quadratic along the ray.
//
// Nothing slips through between cells: the side on which the ray left one is held against the side on which
// it enters the next, so a crossing that rounding hides from both is met at their border.
#include "ridgeline/select/ray_walk.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ridgeline::select {
namespace {

// Boxes are that much higher than their ground, so that the side on which a ray enters one is beyond doubt.
constexpr double kMargin_m = 1e-3;

// Two cells that the ray leaves and enters that near to each other share a border, or a corner. Rounding moves
// borders along a ray by less, and may push it into a third cell between.
constexpr double kBorder_m = 1e-6;

// Corners in the order north-west, north-east, south-west, south-east.
struct Patch {
    std::array<double, 4> height_m{};
    std::array<bool, 4> valid{};

    bool whole() const { return valid[0] && valid[1] && valid[2] && valid[3]; }
    void copy(std::size_t from, std::size_t to) {
        height_m[to] = height_m[from];
        valid[to] = valid[from];
    }
};

Patch patch_at(const CellHeights& cells, int column, int row) {
    Patch patch;
    for (std::size_t corner = 0; corner < 4; ++corner) {
        const std::ptrdiff_t at =
            (row + static_cast<int>(corner >> 1)) * cells.stride + column + static_cast<int>(corner & 1);
        patch.height_m[corner] = cells.offset_m + cells.quanta[at] * cells.quantum_m;
        patch.valid[corner] = cells.valid == nullptr || cells.valid[at] != 0;
    }
    return patch;
}

// A ray that stays on a line of the lattice knows only the corners on it, as heights do there: what lies
// beside it may be a hole. u, v: where in the cell the ray is.
void drop_corners_aside(const LatticeRay& ray, double u, double v, Patch& patch) {
    if (ray.slope.x == 0.0 && (u == 0.0 || u == 1.0))
        for (const std::size_t row : {0u, 2u}) patch.copy(row + (u == 0.0 ? 0 : 1), row + (u == 0.0 ? 1 : 0));
    if (ray.slope.y == 0.0 && (v == 0.0 || v == 1.0))
        for (const std::size_t column : {0u, 1u})
            patch.copy(column + (v == 0.0 ? 0 : 2), column + (v == 0.0 ? 2 : 0));
}

// The height of a ray over a patch, c0 + c1 s + c2 s^2 from where it enters the cell.
struct HeightOver {
    double c0 = 0.0, c1 = 0.0, c2 = 0.0;
    double at(double s) const { return c0 + s * (c1 + s * c2); }
};

HeightOver height_over(const LatticeRay& ray, const glm::dvec3& enters, double u, double v,
                       const std::array<double, 4>& h) {
    const double hu = h[1] - h[0], hv = h[2] - h[0], huv = h[0] - h[1] - h[2] + h[3];
    const double du = ray.slope.x, dv = ray.slope.y;
    return {enters.z - (h[0] + hu * u + hv * v + huv * u * v),
            ray.slope.z - (hu * du + hv * dv + huv * (u * dv + v * du)), -huv * du * dv};
}

// The roots in rising order; none: not a number.
std::array<double, 2> roots(const HeightOver& over) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    const double discriminant = over.c1 * over.c1 - 4.0 * over.c2 * over.c0;
    if (discriminant < 0.0) return {kNone, kNone};
    // The form that subtracts nothing alike; c2 = 0 leaves one root.
    const double q = -0.5 * (over.c1 + std::copysign(std::sqrt(discriminant), over.c1));
    if (q == 0.0) return {kNone, kNone};
    const double a = over.c0 / q, b = over.c2 != 0.0 ? q / over.c2 : a;
    return {std::min(a, b), std::max(a, b)};
}

// The first change of side after s = 0, where the ray has one, up to s = length.
std::optional<double> first_crossing(const HeightOver& over, double length) {
    const auto [a, b] = roots(over);
    const double last = over.at(length);
    const bool crosses_in_all = last == 0.0 || (over.c0 < 0.0) != (last < 0.0);
    if (!crosses_in_all) return a > 0.0 && a < length ? std::optional(a) : std::nullopt;
    // One of the roots lies between, but for rounding.
    if (std::isnan(a)) return std::abs(over.c0) < std::abs(last) ? 0.0 : length;
    const auto outside = [&](double s) { return std::max({-s, s - length, 0.0}); };
    return std::clamp(outside(a) <= outside(b) ? a : b, 0.0, length);
}

// From cell to cell of a node.
class CellSteps {
  public:
    CellSteps(const LatticeRay& ray, const glm::dvec3& start, int quads) : ray_(ray), quads_(quads) {
        for (const int axis : {0, 1}) {
            cell_[axis] = std::clamp(static_cast<int>(std::floor(start[axis])), 0, quads - 1);
            find_leaving(axis);
        }
    }
    int column() const { return cell_[0]; }
    int row() const { return cell_[1]; }
    // Where the ray leaves the cell; infinite for the last one, which ends where the node does.
    double leaves() const { return std::min(leaves_[0], leaves_[1]); }
    void step() {
        const int axis = leaves_[0] <= leaves_[1] ? 0 : 1;
        cell_[axis] += ray_.slope[axis] < 0.0 ? -1 : 1;
        find_leaving(axis);
    }

  private:
    void find_leaving(int axis) {
        const bool down = ray_.slope[axis] < 0.0;
        const bool stays = ray_.slope[axis] == 0.0 || cell_[axis] == (down ? 0 : quads_ - 1);
        leaves_[axis] = stays ? std::numeric_limits<double>::infinity()
                              : (cell_[axis] + (down ? 0 : 1) - ray_.origin[axis]) / ray_.slope[axis];
    }

    const LatticeRay& ray_;
    const int quads_;
    int cell_[2] = {};
    double leaves_[2] = {};
};

}  // namespace

Interval clipped(Interval t, double origin, double slope, double low, double high) {
    if (slope == 0.0) return origin >= low && origin <= high ? t : Interval{1.0, 0.0};
    const double a = (low - origin) / slope, b = (high - origin) / slope;
    return {std::max(t.from, std::min(a, b)), std::min(t.to, std::max(a, b))};
}

Result<std::optional<double>> RayWalk::first(const LatticeRay& ray, Interval reach) {
    ray_ = ray;
    side_ = {};
    met_.reset();
    failure_.reset();
    const std::int32_t columns = grid_.nodes_x(0), rows = grid_.nodes_y(0);
    for (std::int32_t y = 0; y < rows; ++y)
        for (std::int32_t x = 0; x < columns; ++x)
            visit({0, ray.slope.x < 0.0 ? columns - 1 - x : x, ray.slope.y < 0.0 ? rows - 1 - y : y}, reach);
    if (failure_) return *failure_;
    return met_;
}

Interval RayWalk::clipped_to(io::NodeId node, const HeightRange& heights, Interval t) const {
    const double extent = std::ldexp(grid_.quads(), grid_.finest() - node.level);
    const double west = node.x * extent, north = node.y * extent;
    const auto last = [](std::int64_t samples) { return static_cast<double>(samples - 1); };
    t = clipped(t, ray_.origin.x, ray_.slope.x, west, std::min(west + extent, last(grid_.width())));
    t = clipped(t, ray_.origin.y, ray_.slope.y, north, std::min(north + extent, last(grid_.height())));
    const double bottom_m =
        ends_ == Ends::at_surface ? heights.least_m - kMargin_m : -std::numeric_limits<double>::infinity();
    return clipped(t, ray_.origin.z, ray_.slope.z, bottom_m, heights.most_m + kMargin_m);
}

void RayWalk::visit(io::NodeId node, Interval t) {
    if (failure_) return;
    // What was met may lie beside what is still to come, never behind it.
    if (met_) t.to = std::min(t.to, *met_);
    if (t.empty()) return;
    const auto heights = ground_.range(node);
    if (!heights) failure_ = heights.error();
    if (!heights || !*heights) return;
    t = clipped_to(node, **heights, t);
    if (t.empty()) return;
    node.level < ground_.deepest_level() ? visit_children(node, t) : visit_cells(node, t);
}

// In the order in which a ray of that direction passes them.
void RayWalk::visit_children(io::NodeId node, Interval t) {
    const int first = (ray_.slope.x < 0.0 ? 1 : 0) + (ray_.slope.y < 0.0 ? 2 : 0);
    for (const int turn : {0, 1, 2, 3}) visit(node.child(first ^ turn), t);
}

void RayWalk::visit_cells(io::NodeId node, Interval t) {
    const auto cells = ground_.cells(node);
    if (!cells) {
        failure_ = cells.error();
        return;
    }
    const LatticeRay local = ray_in(node);
    CellSteps at(local, local.at(t.from), grid_.quads());
    for (double now = t.from;;) {
        const double next = std::max(std::min(at.leaves(), t.to), now);
        if (meets_cell(*cells, local, at.column(), at.row(), {now, next}) || at.leaves() >= t.to) return;
        at.step();
        now = next;
    }
}

// In cells of the node, which are smaller than the lattice's where it is deeper.
LatticeRay RayWalk::ray_in(io::NodeId node) const {
    const double rate = std::ldexp(1.0, node.level - grid_.finest());
    const glm::dvec3 scale(rate, rate, 1.0);
    const glm::dvec3 corner = static_cast<double>(grid_.quads()) * glm::dvec3(node.x, node.y, 0.0);
    return {ray_.origin * scale - corner, ray_.slope * scale};
}

// Whether the ray, so high over the ground where it enters a cell, has met it there already.
bool RayWalk::has_crossed(double t, double over_m) const {
    if (ends_ == Ends::under_ground) return over_m < 0.0;
    const bool known = std::abs(t - side_.until) <= kBorder_m;
    return over_m == 0.0 || (known && (side_.over_m < 0.0) != (over_m < 0.0));
}

bool RayWalk::meets_cell(const CellHeights& cells, const LatticeRay& local, int column, int row, Interval t) {
    const glm::dvec3 enters = local.at(t.from);
    const double u = enters.x - column, v = enters.y - row;
    Patch patch = patch_at(cells, column, row);
    drop_corners_aside(local, u, v, patch);
    if (!patch.whole()) return false;
    const HeightOver over = height_over(local, enters, u, v, patch.height_m);
    const auto found =
        has_crossed(t.from, over.c0) ? std::optional(0.0) : first_crossing(over, t.to - t.from);
    if (found) met_ = t.from + *found;
    side_ = {t.to, over.at(t.to - t.from)};
    return found.has_value();
}

}  // namespace ridgeline::select
