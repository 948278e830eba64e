#include "ridgeline/app/bench/clipmap.h"

#include <algorithm>

#include "ridgeline/base/contract.h"

namespace ridgeline::app {
namespace {

BlockPlace blocks_of(const BlockPlace& texels, int block_texels) {
    return (texels + std::int64_t{block_texels - 1}) / std::int64_t{block_texels};
}

// One block more than the reach takes: its western edge lies up to a block before where the reach begins.
BlockPlace window_blocks(const glm::dvec2& reach_texels, int block_texels) {
    return BlockPlace(glm::ceil(2.0 * reach_texels / static_cast<double>(block_texels))) + std::int64_t{1};
}

}  // namespace

BlockRectangle BlockRectangle::within(const BlockRectangle& other) const {
    return {glm::max(first, other.first), glm::min(end, other.end)};
}

std::int64_t BlockRectangle::area() const {
    const BlockPlace size = glm::max(end - first, BlockPlace(0));
    return size.x * size.y;
}

ClipmapWindow::ClipmapWindow(const ClipmapLevel& level, const ClipmapFormat& format)
    : format_(format),
      extent_{BlockPlace(0), blocks_of(level.texels, format.block_texels)},
      reach_texels_(level.reach_m / level.texel_m),
      reach_m_(level.reach_m),
      size_(window_blocks(reach_texels_, format.block_texels)) {
    RIDGELINE_CHECK(level.reach_m >= 0.0 && format.block_texels > 0 && format.block_bytes > 0);
}

std::int64_t ClipmapWindow::move_to(const glm::dvec2& eye_texels) {
    const BlockPlace first(
        glm::floor((eye_texels - reach_texels_) / static_cast<double>(format_.block_texels)));
    const BlockRectangle moved{first, first + size_};
    const BlockRectangle data = moved.within(extent_);
    const std::int64_t entering = data.area() - data.within(window_).area();
    window_ = moved;
    return entering * format_.block_bytes;
}

Clipmap::Clipmap(const std::vector<ClipmapLevel>& levels, const ClipmapFormat& format) {
    RIDGELINE_CHECK(!levels.empty());
    const ClipmapLevel& base = levels.front();
    const BlockPlace blocks = blocks_of(base.texels, format.block_texels);
    base_bytes_ = blocks.x * blocks.y * format.block_bytes;
    for (auto level = levels.begin() + 1; level != levels.end(); ++level) {
        windows_.emplace_back(*level, format);
        texel_m_.push_back(level->texel_m);
    }
}

std::int64_t Clipmap::move_to(const glm::dvec2& from_corner_m, double above_ground_m) {
    std::int64_t bytes = 0;
    for (std::size_t i = 0; i < windows_.size(); ++i)
        if (above_ground_m < windows_[i].reach_m()) bytes += windows_[i].move_to(from_corner_m / texel_m_[i]);
    return bytes;
}

}  // namespace ridgeline::app
