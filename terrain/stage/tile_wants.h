// From the tiles of imagery, or of heights, that a frame's schedule chose to what the pager is asked for:
// they and their ancestors, because what is seen at a glancing angle is looked up coarser, a late tile
// sharpens from its parent's texels, and nothing is on the GPU without its parent.
//
// Render thread. After the first frames nothing allocates.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ridgeline/io/grid.h"
#include "ridgeline/io/node_record.h"
#include "ridgeline/pager/pager.h"
#include "ridgeline/select/finest_nodes.h"
#include "ridgeline/select/tile_schedule.h"

namespace ridgeline::stage {

class TileWants {
  public:
    // tiles: with some of the kind. slots: tiles beyond level 0 that can be had at a time.
    TileWants(const pager::TileSpace& tiles, pager::TileKind kind, std::size_t slots);

    // How many tiles the schedule may choose, so that with their ancestors they fill the slots: a fully
    // divided tree has a third as many ancestors as leaves.
    static std::size_t schedule_capacity(std::size_t slots) { return slots - slots / 4; }

    // chosen: in order of urgency, coarse before fine. What is more than the slots hold is cut off the end.
    void gather(std::span<const select::ScheduledTile> chosen) { gather(chosen, {}, {}); }
    // And, after those of their level, tiles of nodes that cells draw if they are seen, and what lies east and south of
    // them: borders are looked up there. records: as in Store::records(); nodes without data have no tile.
    void gather(std::span<const select::ScheduledTile> chosen, std::span<const select::NearNode> cells,
                std::span<const io::NodeRecord> records);
    // In the pager's count, coarse before fine, level 0 included; those of a level in the order of what asked for them.
    std::span<const pager::NodeIndex> tiles() const { return wanted_; }
    // Of them what was chosen, and what only cells need.
    std::span<const pager::NodeIndex> chosen() const { return chosen_; }
    std::span<const pager::NodeIndex> beside() const { return beside_; }
    // Of the chosen ones those that are not on the GPU.
    std::size_t missing(const pager::Pager& pager) const;

  private:
    io::NodeId paged(io::NodeId node) const;
    void add_with_ancestors(io::NodeId node);
    void collect(const std::array<std::size_t, io::Grid::kMaxLevels>& chosen_of_level);
    void add_with_beyond(io::NodeId node, std::span<const io::NodeRecord> records);

    pager::TileSpace space_;
    pager::TileKind kind_;
    std::size_t capacity_;
    std::array<std::vector<pager::NodeIndex>, io::Grid::kMaxLevels> by_level_;
    std::vector<pager::NodeIndex> wanted_, chosen_, beside_;
    pager::LazyArray<std::uint32_t> stamps_;  // by node: the gather() that last added it
    std::uint32_t stamp_ = 0;
};

}  // namespace ridgeline::stage
