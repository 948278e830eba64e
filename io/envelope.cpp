// Literature: the horizon paper (3.2) keeps silhouettes under the chunk's own mesh; under geomorphing
// (ALGORITHMS' "drawn surface") that is not enough, see the header.
//
// The bisection's triangles form a binary forest, so a line is traced by splitting it at the bisectors of the
// triangles that it meets. Nothing is searched, and no case is special: a piece that touches a triangle in
// one point is a piece of length zero.
#include "ridgeline/io/envelope.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace ridgeline::io {
void Envelope::begin(const Grid& grid, NodeId node, const ChunkScratch::State& chunk) {
    chunk_ = &chunk;
    extent_ = static_cast<std::uint32_t>(grid.extent(node.level));
    step_ = static_cast<std::uint32_t>(grid.step(node.level));
    quads_ = grid.quads();
    fans_ = has_fans(grid, node);
    lower_.resize(chunk.quanta.size());
    upper_.resize(chunk.quanta.size());
    for (std::size_t v = 0; v < chunk.quanta.size(); ++v) {
        const std::int32_t own = chunk.quanta[v];
        const std::int32_t morphed =
            chunk.in_parent[v] != 0 ? own : round_to_quantum(chunk.parent_surface[v]);
        lower_[v] = std::min(own, morphed);
        upper_[v] = std::max(own, morphed);
    }
    fill_lattices();
}

// A lattice point that is no vertex halves a hypotenuse that lies in one triangle of the mesh.
void Envelope::fill_lattices() {
    const std::ptrdiff_t stride = quads_ + 1;
    lower_lattice_.assign(static_cast<std::size_t>(stride * stride), kUnset);
    upper_lattice_.resize(static_cast<std::size_t>(stride * stride));
    const auto& vertices = chunk_->bisection.vertices();
    const int shift = std::countr_zero(step_);
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        const std::uint32_t x = vertices[v].x, y = vertices[v].y;
        if (((x | y) & (step_ - 1)) != 0) continue;
        const auto at = (y >> shift) * static_cast<std::size_t>(stride) + (x >> shift);
        lower_lattice_[at] = lower_[v];
        upper_lattice_[at] = upper_[v];
    }
    // Of the coarser scales every point is a vertex (bisection.h).
    for (int s = quads_ / 4; s >= 1; s /= 2) {
        for (int row = s; row < quads_; row += 2 * s)
            for (int column = s; column < quads_; column += 2 * s) {
                const bool falls_eastwards = ((row / s ^ column / s) & 2) == 0;
                fill_between(row * stride + column, falls_eastwards ? s * stride + s : s * stride - s);
            }
        for (int row = 0; row <= quads_; row += 2 * s)
            for (int column = s; column < quads_; column += 2 * s) fill_between(row * stride + column, s);
        for (int row = s; row < quads_; row += 2 * s)
            for (int column = 0; column <= quads_; column += 2 * s)
                fill_between(row * stride + column, s * stride);
    }
}

void Envelope::trace(const Line& line, std::vector<Point>& points) const {
    points.clear();
    if (step_ == 1)
        trace_samples(line, points);
    else
        trace_triangles(line, points);
}

// Cuts the line at the lattice's columns and rows.
void Envelope::trace_samples(const Line& line, std::vector<Point>& points) const {
    const int dx = std::abs(line.to_x - line.from_x), dy = std::abs(line.to_y - line.from_y);
    double from = 0.0;
    for (int column = 1, row = 1; from < 1.0;) {
        // Whichever comes first of column / dx and row / dy, or both.
        const bool at_column = row > dy || (column <= dx && column * dy <= row * dx);
        const bool at_row = column > dx || (row <= dy && row * dx <= column * dy);
        const double to = at_column ? static_cast<double>(column) / dx : static_cast<double>(row) / dy;
        trace_cell(line, from, to, points);
        column += at_column ? 1 : 0;
        row += at_row ? 1 : 0;
        from = to;
    }
}

// A cell of the lattice is two triangles; its diagonal runs between the corners of even and of odd place.
void Envelope::trace_cell(const Line& line, double from, double to, std::vector<Point>& points) const {
    const double dx = line.to_x - line.from_x, dy = line.to_y - line.from_y;
    const double middle = 0.5 * (from + to);
    const int column = std::min(static_cast<int>(line.from_x + middle * dx), quads_ - 1);
    const int row = std::min(static_cast<int>(line.from_y + middle * dy), quads_ - 1);
    const double* corner = &lower_lattice_[static_cast<std::size_t>(row * (quads_ + 1) + column)];
    const double nw = corner[0], ne = corner[1], sw = corner[quads_ + 1], se = corner[quads_ + 2];
    const bool falls_eastwards = ((column ^ row) & 1) == 0;
    const auto quanta_at = [&](double t) {
        const double u = line.from_x + t * dx - column, v = line.from_y + t * dy - row;
        if (falls_eastwards)
            return u >= v ? nw + u * (ne - nw) + v * (se - ne) : nw + v * (sw - nw) + u * (se - sw);
        return u + v <= 1.0 ? nw + u * (ne - nw) + v * (sw - nw)
                            : se + (1.0 - u) * (sw - se) + (1.0 - v) * (ne - se);
    };
    if (points.empty()) points.push_back({from, quanta_at(from)});
    const double slope = falls_eastwards ? dx - dy : dx + dy;
    const double start = falls_eastwards ? (line.from_x - column) - (line.from_y - row)
                                         : (line.from_x - column) + (line.from_y - row) - 1;
    const double crossing = slope != 0.0 ? -start / slope : from;
    if (crossing > from && crossing < to) points.push_back({crossing, quanta_at(crossing)});
    points.push_back({to, quanta_at(to)});
}

void Envelope::trace_leaf(const Bisection::Triangle& triangle, const Ray& ray, double from, double to,
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
        const double x = ray.x + t * ray.dx - apex.x;
        const double y = ray.y + t * ray.dy - apex.y;
        const double quanta = at_apex - offset + (x * ax + y * ay) * rise_a + (x * bx + y * by) * rise_b;
        if (!points.empty() && points.back().along == t)
            points.back().quanta = std::min(points.back().quanta, quanta);
        else
            points.push_back({t, quanta});
    }
}

void Envelope::descend(const Piece& piece, const Ray& ray, std::vector<Point>& points) const {
    const Bisection::Triangle& triangle =
        chunk_->bisection.triangles()[static_cast<std::size_t>(piece.triangle)];
    if (triangle.first_child < 0) return trace_leaf(triangle, ray, piece.from, piece.to, points);
    const auto& vertices = chunk_->bisection.vertices();
    const auto &apex = vertices[triangle.vertex[0]], &a = vertices[triangle.vertex[1]],
               &b = vertices[triangle.vertex[2]];
    // Along the hypotenuse, from the bisector: negative on the first child's side.
    const double nx = static_cast<double>(b.x) - a.x, ny = static_cast<double>(b.y) - a.y;
    const double start = (ray.x - apex.x) * nx + (ray.y - apex.y) * ny;
    const double slope = ray.dx * nx + ray.dy * ny;
    const double at_from = start + piece.from * slope, at_to = start + piece.to * slope;
    const std::int32_t first = triangle.first_child;
    if (at_from <= 0.0 && at_to <= 0.0) return descend({first, piece.from, piece.to}, ray, points);
    if (at_from >= 0.0 && at_to >= 0.0) return descend({first + 1, piece.from, piece.to}, ray, points);
    const double middle = std::clamp(-start / slope, piece.from, piece.to);
    const std::int32_t near = at_from < 0.0 ? first : first + 1, far = at_from < 0.0 ? first + 1 : first;
    descend({near, piece.from, middle}, ray, points);
    descend({far, middle, piece.to}, ray, points);
}

void Envelope::trace_triangles(const Line& line, std::vector<Point>& points) const {
    const double half = extent_ / 2, step = step_;
    const Ray ray{line.from_x * step, line.from_y * step, (line.to_x - line.from_x) * step,
                  (line.to_y - line.from_y) * step};
    const int qx = 2 * std::max(line.from_x, line.to_x) > quads_ ? 1 : 0;
    const int qy = 2 * std::max(line.from_y, line.to_y) > quads_ ? 1 : 0;
    // The quarter's four triangles meet in its centre, parted by its diagonals: west, south, east, north.
    const double cx = (qx + 0.5) * half, cy = (qy + 0.5) * half;
    double cuts[4] = {0.0, 1.0, 1.0, 1.0};
    int count = 1;
    const auto cut = [&](double start, double slope) {
        const double t = -start / slope;
        if (t > 0.0 && t < 1.0) cuts[count++] = t;
    };
    cut(ray.x - cx - (ray.y - cy), ray.dx - ray.dy);
    cut(ray.x - cx + (ray.y - cy), ray.dx + ray.dy);
    if (count == 3 && cuts[1] > cuts[2]) std::swap(cuts[1], cuts[2]);
    cuts[count] = 1.0;
    for (int i = 0; i < count; ++i) {
        const double middle = 0.5 * (cuts[i] + cuts[i + 1]);
        const double x = ray.x + middle * ray.dx - cx, y = ray.y + middle * ray.dy - cy;
        const int place = x <= -std::abs(y) ? 0 : y >= std::abs(x) ? 1 : x >= std::abs(y) ? 2 : 3;
        descend({(qx + 2 * qy) * 4 + place, cuts[i], cuts[i + 1]}, ray, points);
    }
}

}  // namespace ridgeline::io
