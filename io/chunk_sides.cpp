#include "ridgeline/io/chunk_sides.h"

#include <algorithm>

namespace ridgeline::io {

void ChunkSides::begin(const std::vector<Bisection::Vertex>& vertices, std::uint32_t extent) {
    fixed_ = {0, extent, 0, extent, extent / 2, extent / 2};
    for (auto& points : points_) points.clear();
    const auto put = [&](int line, std::uint32_t along, std::size_t v) {
        points_[static_cast<std::size_t>(line)].push_back({along, static_cast<std::uint16_t>(v)});
    };
    // Lines lie half an extent apart: most vertices are on none, which one look at each coordinate tells.
    const std::uint32_t half = extent / 2, off_lines = half - 1;
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        const std::uint32_t x = vertices[v].x, y = vertices[v].y;
        if ((x & off_lines) == 0) put(x == 0 ? 0 : x == extent ? 1 : 4, y, v);
        if ((y & off_lines) == 0) put(y == 0 ? 2 : y == extent ? 3 : 5, x, v);
    }
    for (auto& points : points_)
        std::sort(points.begin(), points.end(),
                  [](const Point& a, const Point& b) { return a.along < b.along; });
}

std::size_t ChunkSides::segment_at(int line, std::uint32_t along) const {
    const auto& points = points_[static_cast<std::size_t>(line)];
    const auto found =
        std::lower_bound(points.begin(), points.end(), along,
                         [](const Point& point, std::uint32_t value) { return point.along < value; });
    return static_cast<std::size_t>(found - points.begin());
}

}  // namespace ridgeline::io
