#include "ridgeline/detail/made_ground.h"

#include <utility>

#include "ridgeline/base/contract.h"

namespace ridgeline::detail {

MadeGround::MadeGround(FinerGround ground, int finest, std::size_t kept_tiles)
    : ground_(std::move(ground)),
      finest_(finest),
      tiles_(static_cast<std::size_t>(ground_.octaves()) + 1, LeastRecentCache<DetailTile>(kept_tiles)) {}

Result<const DetailTile*> MadeGround::tile(io::NodeId node, RootSource& source) {
    RIDGELINE_CHECK(node.level >= finest_ && node.level <= finest_ + ground_.octaves());
    const auto octave = static_cast<std::size_t>(node.level - finest_);
    if (const DetailTile* found = tiles_[octave].find(tile_name(node))) return found;
    if (octave == 0) return root(node, source);
    const auto parent = tile(node.parent(), source);
    if (!parent || *parent == nullptr) return parent;
    DetailTile& made = tiles_[octave].make(tile_name(node));
    make_child(**parent, node.quarter(), ground_.gains[octave - 1], made);
    return static_cast<const DetailTile*>(&made);
}

Result<const DetailTile*> MadeGround::root(io::NodeId node, RootSource& source) {
    DetailTile& root = tiles_.front().make(tile_name(node));
    const auto filled = source.fill_root(node, root);
    if (!filled || !*filled) tiles_.front().forget(tile_name(node));
    if (!filled) return filled.error();
    return *filled ? &root : static_cast<const DetailTile*>(nullptr);
}

}  // namespace ridgeline::detail
