#include "ridgeline/io/chunk_sides.h"

#include <algorithm>

namespace ridgeline::io {

void ChunkSides::begin(const std::vector<Bisection::Vertex>& vertices, std::uint32_t extent) {
    fixed_ = {0, extent, 0, extent, extent / 2, extent / 2};
    for (auto& points : points_) points.clear();
    for (std::size_t v = 0; v < vertices.size(); ++v)
        for (int line = 0; line < kLines; ++line) {
            const bool south = runs_south(line);
            const std::uint32_t across = south ? vertices[v].x : vertices[v].y;
            const std::uint32_t along = south ? vertices[v].y : vertices[v].x;
            if (across == fixed_[static_cast<std::size_t>(line)])
                points_[static_cast<std::size_t>(line)].push_back({along, static_cast<std::uint16_t>(v)});
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
