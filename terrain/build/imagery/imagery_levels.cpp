#include "ridgeline/build/imagery/imagery_levels.h"

#include <algorithm>

#include "ridgeline/base/contract.h"
#include "ridgeline/io/imagery_tile.h"

namespace ridgeline::build {
namespace {

using io::kImageryGutter;
using io::kImageryTexels;
using io::kImageryTile;

// Those of a row of nodes with both gutters, and those that come meanwhile: the finest level's 256 at a time,
// coarser ones' 128, of which the first beyond need make a row of nodes ready.
constexpr std::int64_t kFinestRows = kImageryTexels + kImageryTile;
constexpr std::int64_t kCoarseRows = kImageryGutter + 2 * kImageryTile;

}  // namespace

ImageryLevels::ImageryLevels(std::int64_t width, std::int64_t height)
    : grid_(width + 1, height + 1, kImageryTile), levels_(static_cast<std::size_t>(grid_.levels())) {
    for (int l = grid_.finest(); l >= 0; --l) {
        Level& own = level(l);
        own.width = width, own.height = height;
        own.capacity = l == grid_.finest() ? kFinestRows : kCoarseRows;
        own.texels.resize(static_cast<std::size_t>(own.width * own.capacity));
        width = (width + 1) / 2, height = (height + 1) / 2;
    }
}

std::uint64_t ImageryLevels::memory_bytes(std::int64_t width) {
    return static_cast<std::uint64_t>(width * (kFinestRows + kCoarseRows)) * sizeof(Texel);
}

std::int64_t ImageryLevels::finest_rows_to_fill() const {
    const Level& finest = level(grid_.finest());
    const std::int64_t needed = (finest.next_y + std::int64_t{1}) * kImageryTile + kImageryGutter;
    return std::min(needed, finest.height) - finest.ready;
}

std::span<Texel> ImageryLevels::finest_to_fill(std::int64_t rows) {
    Level& finest = level(grid_.finest());
    rows = std::min(rows, finest.capacity - finest.ready % finest.capacity);
    return {finest.row(finest.ready), static_cast<std::size_t>(rows * finest.width)};
}

void ImageryLevels::filled(std::int64_t rows) { level(grid_.finest()).ready += rows; }

std::vector<NodeRow> ImageryLevels::next() {
    std::vector<NodeRow> rows;
    for (int l = 0; l < grid_.levels(); ++l) {
        Level& own = level(l);
        if (own.next_y == grid_.nodes_y(l)) continue;
        const std::int64_t needed = (own.next_y + std::int64_t{1}) * kImageryTile + kImageryGutter;
        if (own.ready >= std::min(needed, own.height)) rows.push_back({l, own.next_y++});
    }
    return rows;
}

void ImageryLevels::done(const std::vector<NodeRow>& rows) {
    for (const NodeRow& row : rows) {
        if (row.level == 0) continue;
        Level& coarser = level(row.level - 1);
        coarser.ready = std::min((row.y + std::int64_t{1}) * (kImageryTile / 2), coarser.height);
    }
}

bool ImageryLevels::complete() const {
    for (int l = 0; l < grid_.levels(); ++l)
        if (level(l).next_y < grid_.nodes_y(l)) return false;
    return true;
}

void ImageryLevels::cut(io::NodeId node, std::span<Texel> texels) const {
    const Level& own = level(node.level);
    const std::int64_t west = std::int64_t{node.x} * kImageryTile - kImageryGutter;
    const std::int64_t north = std::int64_t{node.y} * kImageryTile - kImageryGutter;
    const std::int64_t first = std::max<std::int64_t>(west, 0);
    const std::int64_t last = std::min(west + kImageryTexels, own.width);
    for (std::int64_t y = 0; y < kImageryTexels; ++y) {
        const Texel* from = own.row(std::clamp<std::int64_t>(north + y, 0, own.height - 1));
        Texel* to = &texels[static_cast<std::size_t>(y * kImageryTexels)];
        std::fill(to, to + (first - west), from[first]);
        std::copy(from + first, from + last, to + (first - west));
        std::fill(to + (last - west), to + kImageryTexels, from[last - 1]);
    }
}

void ImageryLevels::give(io::NodeId node, std::span<const Texel> means) {
    if (node.level == 0) return;
    Level& coarser = level(node.level - 1);
    constexpr std::int64_t kHalf = kImageryTile / 2, kHalfGutter = kImageryGutter / 2;
    const std::int64_t west = node.x * kHalf, north = node.y * kHalf;
    const std::int64_t columns = std::min(kHalf, coarser.width - west);
    const std::int64_t rows = std::min(kHalf, coarser.height - north);
    for (std::int64_t y = 0; y < rows; ++y) {
        const auto at = (y + kHalfGutter) * io::kImageryMipTexels + kHalfGutter;
        std::copy_n(&means[static_cast<std::size_t>(at)], columns, coarser.row(north + y) + west);
    }
}

}  // namespace ridgeline::build
