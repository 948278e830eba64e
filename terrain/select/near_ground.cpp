// A mesh by right-triangle bisection has edges along the lattice and its diagonals only, so along a row or a
// column of the lattice it is straight between lattice points: heights there say all of it.
#include "ridgeline/select/near_ground.h"

#include <algorithm>
#include <cmath>

namespace ridgeline::select {
namespace {

struct Corner {
    int x = 0, y = 0;
    double quanta = 0.0;
};
Corner corner(const io::ChunkVertex& vertex) {
    return {static_cast<int>(vertex.x()), static_cast<int>(vertex.y), static_cast<double>(vertex.quanta)};
}

// Never above what it stands for.
float rounded_down(double quanta) { return static_cast<float>(quanta - std::abs(quanta) * 0x1p-22); }

// Writes a triangle's plane to the lattice points in it. Both neighbours of an edge write the same there.
void fill_triangle(const Corner& a, const Corner& b, const Corner& c, int stride, std::span<float> quanta) {
    const double ux = b.x - a.x, uy = b.y - a.y, vx = c.x - a.x, vy = c.y - a.y;
    const double area = ux * vy - uy * vx;
    const double per_x = ((b.quanta - a.quanta) * vy - (c.quanta - a.quanta) * uy) / area;
    const double per_y = ((c.quanta - a.quanta) * ux - (b.quanta - a.quanta) * vx) / area;
    const double sign = area < 0.0 ? -1.0 : 1.0;
    const auto inside = [&](const Corner& from, const Corner& to, int x, int y) {
        return sign * ((to.x - from.x) * (y - from.y) - (to.y - from.y) * (x - from.x)) >= 0.0;
    };
    for (int y = std::min({a.y, b.y, c.y}); y <= std::max({a.y, b.y, c.y}); ++y)
        for (int x = std::min({a.x, b.x, c.x}); x <= std::max({a.x, b.x, c.x}); ++x)
            if (inside(a, b, x, y) && inside(b, c, x, y) && inside(c, a, x, y))
                quanta[static_cast<std::size_t>(y * stride + x)] =
                    rounded_down(a.quanta + per_x * (x - a.x) + per_y * (y - a.y));
}

}  // namespace

NearGround::NearGround(int quads) : quads_(quads) {
    const auto side = static_cast<std::size_t>(quads) + 1;
    for (Slot& slot : slots_) slot.quanta.resize(side * side);
}

int NearGround::find(NodeIndex node, const io::ChunkView& chunk) {
    ++clock_;
    auto slot = std::find_if(slots_.begin(), slots_.end(), [&](const Slot& s) { return s.node == node; });
    if (slot == slots_.end()) {
        slot = std::min_element(slots_.begin(), slots_.end(),
                                [](const Slot& a, const Slot& b) { return a.used < b.used; });
        slot->node = node;
        fill(chunk, slot->quanta);
    }
    slot->used = clock_;
    return static_cast<int>(slot - slots_.begin());
}

void NearGround::fill(const io::ChunkView& chunk, std::span<float> quanta) const {
    const auto vertices = chunk.vertices();
    const auto indices = chunk.indices();
    const auto fill_range = [&](const io::IndexRange& range) {
        for (std::uint32_t i = range.first; i < range.first + range.count; i += 3)
            fill_triangle(corner(vertices[indices[i]]), corner(vertices[indices[i + 1]]),
                          corner(vertices[indices[i + 2]]), quads_ + 1, quanta);
    };
    for (int q = 0; q < io::kQuarters; ++q) {
        fill_range(chunk.ranges().inside[q]);
        for (int s = 0; s < io::kSides; ++s) fill_range(chunk.ranges().plain[q][s]);
    }
}

}  // namespace ridgeline::select
