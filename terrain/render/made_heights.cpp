#include "ridgeline/render/made_heights.h"

#include <utility>

#include "ridgeline/base/contract.h"
#include "ridgeline/pager/heights_texels.h"
#include "ridgeline/shaders/lib/detail_texels.h"

namespace ridgeline::render {
namespace {

constexpr int kApron = io::HeightsTile::kApron;
// The eye stands over one tile of an octave, seldom two or four; pictures are looked at all over.
constexpr std::size_t kKeptTiles = 16;

class PagedRoots final : public detail::RootSource {
  public:
    PagedRoots(const pager::Pager& pager, int quads, int shift)
        : pager_(pager), quads_(quads), shift_(shift) {}

    Result<bool> fill_root(io::NodeId node, detail::DetailTile& root) override {
        const auto texels = pager_.heights(pager_.tiles().index(pager::TileKind::heights, node));
        if (texels.empty()) return false;
        root.quads = quads_;
        root.node = node;
        root.octave = 0;
        root.heights.resize(texels.size() / sizeof(std::int32_t));
        for (std::size_t i = 0; i < root.heights.size(); ++i)
            root.heights[i] = shaders::finer_height(pager::heights_texel(texels, i), shift_);
        return true;
    }

  private:
    const pager::Pager& pager_;
    int quads_, shift_;
};

}  // namespace

MadeHeights::MadeHeights(detail::FinerGround ground, int finest, int quads)
    : finest_(finest), quads_(quads), made_(std::move(ground), finest, kKeptTiles) {}

std::span<const std::byte> MadeHeights::texels(io::NodeId node, const pager::Pager& pager) {
    const detail::DetailTile* made = tile(node, pager);
    if (!made) return {};
    texels_.clear();
    for (int row = -kApron; row <= quads_ + kApron; ++row)
        for (int column = -kApron; column <= quads_ + kApron; ++column)
            texels_.push_back(
                shaders::made_texel(made->height(column, row), is_terrain(node, {column, row}, pager)));
    return std::as_bytes(std::span(texels_));
}

std::int32_t MadeHeights::texel(io::NodeId node, const glm::ivec2& at, const pager::Pager& pager) {
    const detail::DetailTile* made = tile(node, pager);
    if (!made) return 0;
    const glm::ivec2 cell = at - kApron;
    return shaders::made_texel(made->height(cell), is_terrain(node, cell, pager));
}

const detail::DetailTile* MadeHeights::tile(io::NodeId node, const pager::Pager& pager) {
    PagedRoots roots(pager, quads_, made_.ground().shift);
    const auto found = made_.tile(node, roots);
    RIDGELINE_CHECK(found.ok());  // memory cannot fail
    return *found;
}

// Of the source's cell under a cell that is the tile's own; those of the apron count as terrain.
bool MadeHeights::is_terrain(io::NodeId node, glm::ivec2 cell, const pager::Pager& pager) const {
    for (; node.level > finest_; node = node.parent())
        cell = (cell + glm::ivec2(node.quarter() & 1, node.quarter() >> 1) * quads_) >> 1;
    const auto texels = pager.heights(pager.tiles().index(pager::TileKind::heights, node));
    const glm::ivec2 at = cell + kApron;
    return (pager::heights_texel(texels,
                                 static_cast<std::size_t>(at.y * pager::heights_texels_side(quads_) + at.x)) &
            1) != 0;
}

}  // namespace ridgeline::render
