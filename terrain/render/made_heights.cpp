#include "ridgeline/render/made_heights.h"

#include <utility>

#include "ridgeline/pager/heights_texels.h"
#include "ridgeline/shaders/lib/detail_texels.h"

namespace ridgeline::render {
namespace {

constexpr int kApron = io::HeightsTile::kApron;
// The eye stands over one tile of an octave, seldom two or four; each with those that it is made of.
constexpr std::size_t kKeptTiles = 64;

}  // namespace

MadeHeights::MadeHeights(detail::FinerGround ground, int finest, int quads)
    : ground_(std::move(ground)), finest_(finest), quads_(quads), tiles_(kKeptTiles) {}

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

// What lies in the cache was made of a source that never changes.
const detail::DetailTile* MadeHeights::tile(io::NodeId node, const pager::Pager& pager) {
    if (const detail::DetailTile* found = tiles_.find(detail::tile_name(node))) return found;
    if (node.level == finest_) {
        const auto texels = pager.heights(pager.tiles().index(pager::TileKind::heights, node));
        return texels.empty() ? nullptr : &root(node, texels);
    }
    const detail::DetailTile* parent = tile(node.parent(), pager);
    if (!parent) return nullptr;
    detail::DetailTile& made = tiles_.make(detail::tile_name(node));
    detail::make_child(*parent, node.quarter(), ground_.gains[static_cast<std::size_t>(parent->octave)],
                       made);
    return &made;
}

const detail::DetailTile& MadeHeights::root(io::NodeId node, std::span<const std::byte> texels) {
    detail::DetailTile& made = tiles_.make(detail::tile_name(node));
    made.quads = quads_;
    made.node = node;
    made.octave = 0;
    made.heights.resize(texels.size() / sizeof(std::int32_t));
    for (std::size_t i = 0; i < made.heights.size(); ++i)
        made.heights[i] = shaders::finer_height(pager::heights_texel(texels, i), ground_.shift);
    return made;
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
