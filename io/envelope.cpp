// Literature: the horizon paper (3.2) keeps silhouettes under the chunk's own mesh; under geomorphing
// (ALGORITHMS' "drawn surface") that is not enough, see the header.
//
// The bisection's triangles form a binary forest, so a line is traced by splitting it at the bisectors of the
// triangles that it meets. Nothing is searched, and no case is special: a piece that touches a triangle in one
// point is a piece of length zero.
#include "ridgeline/io/envelope.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ridgeline::io {
namespace {

// No height, which are within 2^29 quanta.
constexpr double kUnset = std::numeric_limits<double>::max();

// Gives the unset points of one scale, whose hypotenuses run as (dx, dy) says, the mean of their ends.
void fill_between(double* point, std::ptrdiff_t to_end) {
    if (*point == kUnset) *point = 0.5 * (point[-to_end] + point[to_end]);
}

}  // namespace

void Envelope::begin(const Grid& grid, NodeId node, const ChunkScratch::State& chunk) {
    chunk_ = &chunk;
    extent_ = static_cast<std::uint32_t>(grid.extent(node.level));
    step_ = static_cast<std::uint32_t>(grid.step(node.level));
    quads_ = grid.quads();
    fans_ = has_fans(grid, node);
    lower_.resize(chunk.quanta.size());
    upper_.resize(chunk.quanta.size());
    for (std::size_t v = 0; v < chunk.quanta.size(); ++v) {
        const std::int32_t own = chunk.quanta[v], morphed = round_to_quantum(chunk.parent_surface[v]);
        lower_[v] = std::min(own, morphed);
        upper_[v] = std::max(own, morphed);
    }
    fill_lattice(lower_, lower_lattice_);
    fill_lattice(upper_, upper_lattice_);
}

// A lattice point that is no vertex halves a hypotenuse that lies in one triangle of the mesh.
void Envelope::fill_lattice(std::span<const std::int32_t> heights, std::vector<double>& lattice) const {
    const std::ptrdiff_t stride = quads_ + 1;
    lattice.assign(static_cast<std::size_t>(stride * stride), kUnset);
    const auto& vertices = chunk_->bisection.vertices();
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        const std::uint32_t x = vertices[v].x, y = vertices[v].y;
        if (((x | y) & (step_ - 1)) == 0) lattice[(y / step_) * static_cast<std::size_t>(stride) + x / step_] = heights[v];
    }
    // Coarser points are always vertices (bisection.h).
    for (int s = quads_ / 8; s >= 1; s /= 2) {
        for (int row = s; row < quads_; row += 2 * s)
            for (int column = s; column < quads_; column += 2 * s) {
                const bool falls_eastwards = ((row / s ^ column / s) & 2) == 0;
                fill_between(&lattice[static_cast<std::size_t>(row * stride + column)],
                             falls_eastwards ? s * stride + s : s * stride - s);
            }
        for (int row = 0; row <= quads_; row += 2 * s)
            for (int column = s; column < quads_; column += 2 * s)
                fill_between(&lattice[static_cast<std::size_t>(row * stride + column)], s);
        for (int row = s; row < quads_; row += 2 * s)
            for (int column = 0; column <= quads_; column += 2 * s)
                fill_between(&lattice[static_cast<std::size_t>(row * stride + column)], s * stride);
    }
}

void Envelope::trace_leaf(const Bisection::Triangle& triangle, const Line& line, double from, double to,
                          std::vector<Point>& points) const {
    const auto& vertices = chunk_->bisection.vertices();
    const auto &apex = vertices[triangle.vertex[0]], &a = vertices[triangle.vertex[1]],
               &b = vertices[triangle.vertex[2]];
    // The legs are perpendicular and of one length, so a height is a sum over two projections.
    const double ax = static_cast<double>(a.x) - apex.x, ay = static_cast<double>(a.y) - apex.y;
    const double bx = static_cast<double>(b.x) - apex.x, by = static_cast<double>(b.y) - apex.y;
    const double per_length2 = 1.0 / (ax * ax + ay * ay);
    const double at_apex = lower_[triangle.vertex[0]];
    const double rise_a = (lower_[triangle.vertex[1]] - at_apex) * per_length2;
    const double rise_b = (lower_[triangle.vertex[2]] - at_apex) * per_length2;
    const double offset = fans_ && triangle.side_edge != Bisection::Edge::none ? kFanOffset : 0.0;
    for (const double t : {from, to}) {
        const double x = line.from_x + t * (line.to_x - line.from_x) - apex.x;
        const double y = line.from_y + t * (line.to_y - line.from_y) - apex.y;
        const double quanta = at_apex - offset + (x * ax + y * ay) * rise_a + (x * bx + y * by) * rise_b;
        if (!points.empty() && points.back().along == t)
            points.back().quanta = std::min(points.back().quanta, quanta);
        else
            points.push_back({t, quanta});
    }
}

void Envelope::descend(const Piece& piece, const Line& line, std::vector<Point>& points) const {
    const Bisection::Triangle& triangle = chunk_->bisection.triangles()[static_cast<std::size_t>(piece.triangle)];
    if (triangle.first_child < 0) return trace_leaf(triangle, line, piece.from, piece.to, points);
    const auto& vertices = chunk_->bisection.vertices();
    const auto &apex = vertices[triangle.vertex[0]], &a = vertices[triangle.vertex[1]],
               &b = vertices[triangle.vertex[2]];
    // Along the hypotenuse, from the bisector: negative on the first child's side.
    const double nx = static_cast<double>(b.x) - a.x, ny = static_cast<double>(b.y) - a.y;
    const double start = (line.from_x - apex.x) * nx + (line.from_y - apex.y) * ny;
    const double slope = (line.to_x - line.from_x) * nx + (line.to_y - line.from_y) * ny;
    const double at_from = start + piece.from * slope, at_to = start + piece.to * slope;
    const std::int32_t first = triangle.first_child;
    if (at_from <= 0.0 && at_to <= 0.0) return descend({first, piece.from, piece.to}, line, points);
    if (at_from >= 0.0 && at_to >= 0.0) return descend({first + 1, piece.from, piece.to}, line, points);
    const double middle = std::clamp(-start / slope, piece.from, piece.to);
    const std::int32_t near = at_from < 0.0 ? first : first + 1, far = at_from < 0.0 ? first + 1 : first;
    descend({near, piece.from, middle}, line, points);
    descend({far, middle, piece.to}, line, points);
}

void Envelope::trace(const Line& line, std::vector<Point>& points) const {
    points.clear();
    const double half = extent_ / 2;
    const int qx = std::max(line.from_x, line.to_x) > half ? 1 : 0;
    const int qy = std::max(line.from_y, line.to_y) > half ? 1 : 0;
    // The quarter's four triangles meet in its centre, parted by its diagonals: west, south, east, north.
    const double cx = (qx + 0.5) * half, cy = (qy + 0.5) * half;
    const double dx = line.to_x - line.from_x, dy = line.to_y - line.from_y;
    double cuts[4] = {0.0, 1.0, 1.0, 1.0};
    int count = 1;
    const auto cut = [&](double start, double slope) {
        const double t = -start / slope;
        if (t > 0.0 && t < 1.0) cuts[count++] = t;
    };
    cut(line.from_x - cx - (line.from_y - cy), dx - dy);
    cut(line.from_x - cx + (line.from_y - cy), dx + dy);
    if (count == 3 && cuts[1] > cuts[2]) std::swap(cuts[1], cuts[2]);
    cuts[count] = 1.0;
    for (int i = 0; i < count; ++i) {
        const double middle = 0.5 * (cuts[i] + cuts[i + 1]);
        const double x = line.from_x + middle * dx - cx, y = line.from_y + middle * dy - cy;
        const int place = x <= -std::abs(y) ? 0 : y >= std::abs(x) ? 1 : x >= std::abs(y) ? 2 : 3;
        descend({(qx + 2 * qy) * 4 + place, cuts[i], cuts[i + 1]}, line, points);
    }
}

}  // namespace ridgeline::io
