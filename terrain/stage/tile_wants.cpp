#include "ridgeline/stage/tile_wants.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace ridgeline::stage {

using pager::TileKind;

TileWants::TileWants(const pager::TileSpace& tiles, TileKind kind, std::size_t slots)
    : space_(tiles),
      kind_(kind),
      capacity_(slots + tiles.root_count(kind)),
      stamps_(static_cast<std::size_t>(tiles.grid(kind).node_count())) {
    RIDGELINE_CHECK(stamps_);
    for (auto& level : by_level_) level.reserve(slots);
    for (auto* list : {&wanted_, &chosen_, &beside_}) list->reserve(capacity_);
}

// An ancestor that was added has its own there already.
void TileWants::add_with_ancestors(io::NodeId node) {
    for (;; node = node.parent()) {
        const pager::NodeIndex tile = space_.index(kind_, node);
        std::uint32_t& stamp = stamps_[tile - space_.begin(kind_)];
        if (stamp == stamp_) return;
        stamp = stamp_;
        by_level_[static_cast<std::size_t>(node.level)].push_back(tile);
        if (node.level == 0) return;
    }
}

// Of the node or, where that is made below the source, of what it is made from.
io::NodeId TileWants::paged(io::NodeId node) const {
    const int made = std::max(node.level - space_.grid(kind_).finest(), 0);
    return {node.level - made, node.x >> made, node.y >> made};
}

void TileWants::add_with_beyond(io::NodeId node, std::span<const io::NodeRecord> records) {
    const io::Grid& grid = space_.grid(kind_);
    for (const auto& [east, south] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 1}}) {
        const io::NodeId beyond{node.level, node.x + east, node.y + south};
        if (grid.contains(beyond) && records[static_cast<std::size_t>(grid.linear(beyond))].has_data())
            add_with_ancestors(beyond);
    }
}

void TileWants::gather(std::span<const select::ScheduledTile> chosen, std::span<const select::NearNode> cells,
                       std::span<const io::NodeRecord> records) {
    ++stamp_;
    for (auto& level : by_level_) level.clear();
    for (const select::ScheduledTile& tile : chosen) add_with_ancestors(paged(tile.node));
    std::array<std::size_t, io::Grid::kMaxLevels> chosen_of_level{};
    for (std::size_t i = 0; i < by_level_.size(); ++i) chosen_of_level[i] = by_level_[i].size();
    for (const select::NearNode& near : cells) add_with_beyond(near.node, records);
    collect(chosen_of_level);
}

// All that was chosen takes its room first.
void TileWants::collect(const std::array<std::size_t, io::Grid::kMaxLevels>& chosen_of_level) {
    wanted_.clear();
    chosen_.clear();
    beside_.clear();
    const std::size_t all_chosen = std::reduce(chosen_of_level.begin(), chosen_of_level.end());
    std::size_t chosen_room = std::min(capacity_, all_chosen), beside_room = capacity_ - chosen_room;
    const auto take = [this](std::span<const pager::NodeIndex> tiles, std::size_t& room, auto& list) {
        const auto taken = tiles.first(std::min(tiles.size(), room));
        room -= taken.size();
        wanted_.insert(wanted_.end(), taken.begin(), taken.end());
        list.insert(list.end(), taken.begin(), taken.end());
    };
    for (std::size_t i = 0; i < by_level_.size(); ++i) {
        const std::span<const pager::NodeIndex> level = by_level_[i];
        take(level.first(chosen_of_level[i]), chosen_room, chosen_);
        take(level.subspan(chosen_of_level[i]), beside_room, beside_);
    }
}

std::size_t TileWants::missing(const pager::Pager& pager) const {
    return static_cast<std::size_t>(std::ranges::count_if(
        chosen_, [&](pager::NodeIndex tile) { return pager.state(tile) != pager::TileState::resident; }));
}

}  // namespace ridgeline::stage
