#include "ridgeline/render/made_region.h"

#include <algorithm>
#include <utility>

#include "ridgeline/render/height_texture.h"

namespace ridgeline::render {
namespace {

using io::NodeId;
using io::Side;

constexpr Side kEverySide[io::kSides] = {Side::west, Side::east, Side::north, Side::south};

NodeId ancestor(NodeId id, int level) {
    const int up = id.level - level;
    return {level, id.x >> up, id.y >> up};
}

}  // namespace

void MadeRegion::find(Draws draws, std::span<const select::NearNode> near, const HeightTexture& heights,
                      const pager::Pager& pager) {
    drawn_.clear();
    nodes_.clear();
    for (const select::DrawEntry& entry : draws) drawn_.push_back({entry.index, &entry});
    std::ranges::sort(drawn_, {}, &Drawn::index);
    for (const select::NearNode& at : near)
        if (may_change_hands(at.node, heights, pager)) nodes_.push_back({at.node});
    std::ranges::sort(nodes_, {}, [this](const Node& node) { return grid_.linear(node.id); });
    find_above();
    for (Node& node : nodes_) find_seams(node, pager);
    drawn_.clear();
}

const MadeRegion::Node* MadeRegion::node(NodeId id) const {
    if (id.level != grid_.finest() || !grid_.contains(id)) return nullptr;
    const auto found = std::ranges::lower_bound(nodes_, grid_.linear(id), {},
                                                [this](const Node& held) { return grid_.linear(held.id); });
    return found == nodes_.end() || found->id != id ? nullptr : &*found;
}

bool MadeRegion::concerns(NodeId tile) const {
    if (tile.level >= grid_.finest()) return node(ancestor(tile, grid_.finest())) != nullptr;
    return std::ranges::binary_search(above_, grid_.linear(tile));
}

void MadeRegion::find_above() {
    above_.clear();
    for (const Node& node : nodes_)
        for (NodeId id = node.id; id.level > 0;) above_.push_back(grid_.linear(id = id.parent()));
    std::ranges::sort(above_);
    above_.erase(std::unique(above_.begin(), above_.end()), above_.end());
}

bool MadeRegion::concerns_place(const glm::dvec2& place) const {
    const auto extent = static_cast<double>(grid_.extent(grid_.finest()));
    return std::ranges::any_of(nodes_, [&](const Node& node) {
        const glm::dvec2 within = place / extent - glm::dvec2(node.id.x, node.id.y);
        return within.x >= 0.0 && within.y >= 0.0 && within.x <= 1.0 && within.y <= 1.0;
    });
}

const select::DrawEntry* MadeRegion::drawn(NodeId id) const {
    if (!grid_.contains(id)) return nullptr;
    const auto index = static_cast<select::NodeIndex>(grid_.linear(id));
    const auto found = std::ranges::lower_bound(drawn_, index, {}, &Drawn::index);
    return found != drawn_.end() && found->index == index ? found->entry : nullptr;
}

// A place on the eastern or southern border is looked up in the node beyond it.
bool MadeRegion::may_change_hands(NodeId id, const HeightTexture& heights, const pager::Pager& pager) const {
    if (!drawn(id) || meets_coarser(id)) return false;
    for (const auto& [east, south] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 1}})
        if (!has_turned({id.level, id.x + east, id.y + south}, heights, pager)) return false;
    return true;
}

// Nodes without data have no tile, and nothing is looked up there.
bool MadeRegion::has_turned(NodeId id, const HeightTexture& heights, const pager::Pager& pager) const {
    if (!grid_.contains(id)) return true;
    const pager::NodeIndex tile = pager.tiles().index(pager::TileKind::heights, id);
    const pager::TileState state = pager.state(tile);
    if (state == pager::TileState::resident)
        return heights.tiles().fade(static_cast<std::uint32_t>(pager.gpu_slot(tile))) <= 0.0f;
    return !records_[static_cast<std::size_t>(grid_.linear(id))].has_data();
}

bool MadeRegion::meets_coarser(NodeId id) const {
    return std::ranges::any_of(kEverySide, [&](Side side) {
        const NodeId beside = io::neighbour(id, side);
        if (!grid_.contains(beside) || drawn(beside)) return false;
        for (NodeId child = beside; child.level > 0; child = child.parent())
            if (const auto* entry = drawn(child.parent());
                entry && (entry->quarters >> child.quarter() & 1) != 0)
                return true;
        return false;
    });
}

// Chunks of one level have the same vertices on the border that they share, so the node's own tells of its
// neighbours'.
void MadeRegion::find_seams(Node& node, const pager::Pager& pager) const {
    const io::ChunkView chunk = pager.chunk(static_cast<pager::NodeIndex>(grid_.linear(node.id)));
    const auto last = static_cast<std::uint32_t>(grid_.extent(node.id.level));
    for (const Side side : kEverySide) {
        const NodeId beside = io::neighbour(node.id, side);
        if (!drawn(beside) || this->node(beside)) continue;
        auto& seam = node.seams[static_cast<std::size_t>(io::index(side))];
        const bool west_east = side == Side::west || side == Side::east;
        const std::uint32_t border = side == Side::west || side == Side::north ? 0 : last;
        for (const io::ChunkVertex& vertex : chunk.vertices()) {
            const std::uint32_t across = west_east ? vertex.x() : vertex.y;
            const std::uint32_t along = west_east ? vertex.y : vertex.x();
            if (across == border && along < last) seam[along / 32] |= 1u << along % 32;
        }
    }
}

select::DrawEntry MadeRegion::beside(const select::DrawEntry& entry) const {
    select::DrawEntry meeting = entry;
    if (entry.node.level != grid_.finest()) return meeting;
    for (const Side side : kEverySide) {
        if (!node(io::neighbour(entry.node, side))) continue;
        for (const int morph_class : {io::vertex_class::outer(side, 0), io::vertex_class::outer(side, 1),
                                      io::vertex_class::midpoint(side)})
            meeting.morph[static_cast<std::size_t>(morph_class)] = {};
    }
    return meeting;
}

}  // namespace ridgeline::render
