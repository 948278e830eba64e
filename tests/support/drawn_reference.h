// The surface of a chunk as it may be drawn, slowly and exactly: any weight at any vertex that morphs, plain
// or fanned sides. What reliefs promise is held against it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "ridgeline/io/chunk.h"
#include "ridgeline/io/grid.h"

namespace ridgeline::test {

struct SurfacePoint {
    double x = 0.0, y = 0.0;  // finest samples from the node's corner
    double quanta = 0.0;
};
using SurfaceTriangle = std::array<SurfacePoint, 3>;

// How vertices morph: all at one weight, or each at its own, from 0 to 1.
enum class Morph { own, parent, lesser, greater, random };

inline std::vector<SurfaceTriangle> drawn_triangles(const io::ChunkView& chunk, Morph morph,
                                                    std::mt19937& random) {
    std::vector<double> weights;
    std::array<double, io::vertex_class::kCount> of_class{};
    for (double& weight : of_class) weight = std::uniform_real_distribution(0.0, 1.0)(random);
    const bool by_class = random() % 2 == 0;
    for (const io::ChunkVertex& v : chunk.vertices())
        weights.push_back(morph == Morph::own       ? 0.0
                          : morph == Morph::parent  ? 1.0
                          : morph == Morph::lesser  ? (v.delta < 0 ? 1.0 : 0.0)
                          : morph == Morph::greater ? (v.delta > 0 ? 1.0 : 0.0)
                          : by_class                ? of_class[static_cast<std::size_t>(v.morph_class())]
                                                    : std::uniform_real_distribution(0.0, 1.0)(random));
    std::vector<SurfaceTriangle> triangles;
    const auto draw = [&](const io::IndexRange& range) {
        for (std::uint32_t i = range.first; i < range.first + range.count; i += 3) {
            SurfaceTriangle triangle;
            for (std::size_t k = 0; k < 3; ++k) {
                const std::size_t at = chunk.indices()[i + k];
                const io::ChunkVertex& v = chunk.vertices()[at];
                triangle[k] = {static_cast<double>(v.x()), static_cast<double>(v.y),
                               v.quanta + weights[at] * v.delta};
            }
            triangles.push_back(triangle);
        }
    };
    for (int q = 0; q < io::kQuarters; ++q) {
        draw(chunk.ranges().inside[q]);
        for (int s = 0; s < io::kSides; ++s) {
            const bool fan = chunk.ranges().fan[q][s].count > 0 && random() % 2 == 0;
            draw(fan ? chunk.ranges().fan[q][s] : chunk.ranges().plain[q][s]);
        }
    }
    return triangles;
}

// The part of a polygon where a * x + b * y <= c.
inline std::vector<SurfacePoint> clipped(const std::vector<SurfacePoint>& polygon, double a, double b,
                                         double c) {
    std::vector<SurfacePoint> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const SurfacePoint &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
        const double at_p = a * p.x + b * p.y - c, at_q = a * q.x + b * q.y - c;
        if (at_p <= 0.0) kept.push_back(p);
        if ((at_p < 0.0 && at_q > 0.0) || (at_p > 0.0 && at_q < 0.0)) {
            const double t = at_p / (at_p - at_q);
            kept.push_back(
                {p.x + t * (q.x - p.x), p.y + t * (q.y - p.y), p.quanta + t * (q.quanta - p.quanta)});
        }
    }
    return kept;
}

// How far a straight segment rises over a triangle at most; negative: how far it stays below; nothing where
// they do not meet.
inline std::optional<double> excess(const SurfacePoint& from, const SurfacePoint& to,
                                    const SurfaceTriangle& triangle) {
    const auto [min_x, max_x] = std::minmax({triangle[0].x, triangle[1].x, triangle[2].x});
    const auto [min_y, max_y] = std::minmax({triangle[0].y, triangle[1].y, triangle[2].y});
    if (std::max(from.x, to.x) < min_x || std::min(from.x, to.x) > max_x || std::max(from.y, to.y) < min_y ||
        std::min(from.y, to.y) > max_y)
        return {};
    const auto area = [](const SurfacePoint& a, const SurfacePoint& b, double x, double y) {
        return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
    };
    const double whole = area(triangle[0], triangle[1], triangle[2].x, triangle[2].y);
    double first = 0.0, last = 1.0;
    for (std::size_t k = 0; k < 3; ++k) {
        const SurfacePoint &a = triangle[k], &b = triangle[(k + 1) % 3];
        const double start = area(a, b, from.x, from.y) / whole, end = area(a, b, to.x, to.y) / whole;
        if (start < 0.0 && end < 0.0) return {};
        if (start < 0.0) first = std::max(first, start / (start - end));
        if (end < 0.0) last = std::min(last, start / (start - end));
    }
    if (first > last) return {};
    double most = -1e30;
    for (const double t : {first, last}) {
        const double x = from.x + t * (to.x - from.x), y = from.y + t * (to.y - from.y);
        double surface = 0.0;
        for (std::size_t k = 0; k < 3; ++k)
            surface += area(triangle[(k + 1) % 3], triangle[(k + 2) % 3], x, y) / whole * triangle[k].quanta;
        most = std::max(most, from.quanta + t * (to.quanta - from.quanta) - surface);
    }
    return most;
}

struct ChainSegment {
    SurfacePoint from, to;
};
// All segments that may hide something.
inline std::vector<ChainSegment> segments_of(const io::ReliefView& relief, const io::NodeRecord& record,
                                             double extent, int quads) {
    std::vector<ChainSegment> segments;
    for (const io::ReliefAxis axis : {io::ReliefAxis::east, io::ReliefAxis::south})
        for (int band = 0; band < relief.shape().bands; ++band) {
            const auto heights = relief.heights(axis, band);
            const auto acrosses = relief.across(axis, band);
            const auto point = [&](int i) {
                const double along = i * extent / relief.shape().steps;
                const double across = acrosses[static_cast<std::size_t>(i)] * extent / quads;
                const double quanta = io::chain_height::quanta(heights[static_cast<std::size_t>(i)], record);
                return axis == io::ReliefAxis::east ? SurfacePoint{along, across, quanta}
                                                    : SurfacePoint{across, along, quanta};
            };
            for (int i = 0; i < relief.shape().steps; ++i)
                if (heights[static_cast<std::size_t>(i)] != io::chain_height::kHidesNothing &&
                    heights[static_cast<std::size_t>(i) + 1] != io::chain_height::kHidesNothing)
                    segments.push_back({point(i), point(i + 1)});
        }
    return segments;
}

// The most by which any segment rises over the surface.
inline double chains_excess(const std::vector<ChainSegment>& segments,
                            const std::vector<SurfaceTriangle>& surface) {
    double most = -1e30;
    for (const ChainSegment& segment : segments)
        for (const SurfaceTriangle& triangle : surface)
            if (const auto over = excess(segment.from, segment.to, triangle)) most = std::max(most, *over);
    return most;
}

// A square's side that lies on a cell's border stays there when divided.
constexpr double kOnBorder = 1e-9;

// The square of a node within that of an ancestor (or of itself), finest samples from the ancestor's corner.
struct Square {
    double x = 0.0, y = 0.0, side = 0.0;
};

// The most by which a node's surface rises over the maxima of an ancestor in the cells of the node's square.
inline double maxima_excess(const io::ReliefView& relief, const io::NodeRecord& record, double extent,
                            const Square& square, const std::vector<SurfaceTriangle>& surface) {
    const double x = square.x, y = square.y;
    const int cells = relief.shape().cells;
    const double size = extent / cells;
    double most = -1e30;
    for (const SurfaceTriangle& triangle : surface) {
        const auto [min_x, max_x] = std::minmax({triangle[0].x, triangle[1].x, triangle[2].x});
        const auto [min_y, max_y] = std::minmax({triangle[0].y, triangle[1].y, triangle[2].y});
        // Closed cells: one that is touched counts.
        const auto first = [&](double least, double corner) {
            return std::max(static_cast<int>(std::floor(corner / size + kOnBorder)),
                            static_cast<int>(std::ceil((least + corner) / size)) - 1);
        };
        const auto last = [&](double greatest, double corner) {
            return std::min(static_cast<int>(std::ceil((corner + square.side) / size - kOnBorder)) - 1,
                            static_cast<int>(std::floor((greatest + corner) / size)));
        };
        const int first_column = first(min_x, x), last_column = last(max_x, x);
        const int first_row = first(min_y, y), last_row = last(max_y, y);
        for (int row = first_row; row <= last_row; ++row)
            for (int column = first_column; column <= last_column; ++column) {
                std::vector<SurfacePoint> part(triangle.begin(), triangle.end());
                part = clipped(part, -1.0, 0.0, x - column * size);
                part = clipped(part, 1.0, 0.0, (column + 1) * size - x);
                part = clipped(part, 0.0, -1.0, y - row * size);
                part = clipped(part, 0.0, 1.0, (row + 1) * size - y);
                const double bound = io::maximum_quanta(
                    relief.maxima()[static_cast<std::size_t>(row * cells + column)], record);
                for (const SurfacePoint& point : part) most = std::max(most, point.quanta - bound);
            }
    }
    return most;
}

// Whether some place of a segment belongs to no valid cell, or to an invalid one as well.
inline bool touches_void(const ChainSegment& segment, const io::ChunkView& chunk, double extent, int quads) {
    if (chunk.mask().empty()) return false;
    const double cell = extent / quads;
    constexpr int kSamples = 400;
    for (int i = 0; i <= kSamples; ++i) {
        const double t = static_cast<double>(i) / kSamples;
        const double x = (segment.from.x + t * (segment.to.x - segment.from.x)) / cell;
        const double y = (segment.from.y + t * (segment.to.y - segment.from.y)) / cell;
        for (int row = std::max(0, static_cast<int>(std::ceil(y)) - 1);
             row <= std::min(quads - 1, static_cast<int>(y)); ++row)
            for (int column = std::max(0, static_cast<int>(std::ceil(x)) - 1);
                 column <= std::min(quads - 1, static_cast<int>(x)); ++column) {
                const auto at = static_cast<std::size_t>(row * quads + column);
                if ((chunk.mask()[at / 32] >> (at % 32) & 1u) == 0) return true;
            }
    }
    return false;
}

}  // namespace ridgeline::test
