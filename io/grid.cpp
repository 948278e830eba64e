#include "ridgeline/io/grid.h"

#include <algorithm>
#include <bit>

#include "ridgeline/base/contract.h"

namespace ridgeline::io {
namespace {

std::int64_t ceil_divide(std::int64_t a, std::int64_t b) { return (a + b - 1) / b; }

}  // namespace

Grid::Grid(std::int64_t width, std::int64_t height, int quads)
    : width_(width), height_(height), quads_(quads) {
    RIDGELINE_CHECK(width >= 2 && height >= 2 && quads >= 32 && quads <= 256);
    RIDGELINE_CHECK(std::has_single_bit(static_cast<unsigned>(quads)));
    const std::int64_t shorter = std::min(width, height) - 1;
    for (levels_ = 1; extent(0) < shorter; ++levels_) RIDGELINE_CHECK(levels_ < kMaxLevels);
    lay_out_nodes();
}

Grid Grid::finer(int octaves) const {
    RIDGELINE_CHECK(octaves >= 0 && levels_ + octaves <= kMaxLevels);
    Grid grid = *this;
    grid.width_ = ((width_ - 1) << octaves) + 1;
    grid.height_ = ((height_ - 1) << octaves) + 1;
    grid.levels_ += octaves;
    grid.lay_out_nodes();
    return grid;
}

void Grid::lay_out_nodes() {
    for (int level = 0; level < levels_; ++level) {
        const auto l = static_cast<std::size_t>(level);
        nodes_x_[l] = static_cast<std::int32_t>(ceil_divide(width_ - 1, extent(level)));
        nodes_y_[l] = static_cast<std::int32_t>(ceil_divide(height_ - 1, extent(level)));
        first_[l + 1] = first_[l] + std::int64_t{nodes_x_[l]} * nodes_y_[l];
    }
}

NodeId Grid::node_at(std::int64_t linear) const {
    RIDGELINE_CHECK(linear >= 0 && linear < node_count());
    int level = 0;
    while (linear >= first(level + 1)) ++level;
    const std::int64_t within = linear - first(level);
    return {level, static_cast<std::int32_t>(within % nodes_x(level)),
            static_cast<std::int32_t>(within / nodes_x(level))};
}

std::uint64_t hilbert_index(std::int32_t x, std::int32_t y, int order) {
    std::uint64_t index = 0;
    for (std::int64_t s = std::int64_t{1} << order >> 1; s > 0; s >>= 1) {
        const bool right = (x & s) != 0;
        const bool lower = (y & s) != 0;
        index += static_cast<std::uint64_t>(s) * static_cast<std::uint64_t>(s) *
                 ((right ? 3u : 0u) ^ (lower ? 1u : 0u));
        if (lower) continue;
        // Turn the quadrant so that the curve enters and leaves it at the right corners.
        if (right) {
            x = static_cast<std::int32_t>(s - 1) - (x & static_cast<std::int32_t>(s - 1));
            y = static_cast<std::int32_t>(s - 1) - (y & static_cast<std::int32_t>(s - 1));
        }
        std::swap(x, y);
    }
    return index;
}

}  // namespace ridgeline::io
