// The tiles that a frame wants of one texture over the ground: what its selection, the last readback and the
// texture's quadtree say together.
//
// Runs after the selection, in its job. The terrain's info and records outlive it. Not to be copied or moved:
// its parts know each other.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>

#include "ridgeline/select/seen_ground.h"
#include "ridgeline/select/tile_schedule.h"

namespace ridgeline::select {

// A texture over the ground, and the slots of its cache: the paper's N.
struct ScheduledTexture {
    TileTree tree;
    std::size_t slots = 512;
};

class GroundSchedule {
  public:
    GroundSchedule(const io::TerrainInfo& info, std::span<const io::NodeRecord> records,
                   ScheduledTexture texture)
        : bounds_(info, records),
          seen_(info, bounds_.terrain()),
          schedule_(std::move(texture.tree), bounds_, texture.slots) {}
    GroundSchedule(const GroundSchedule&) = delete;
    GroundSchedule& operator=(const GroundSchedule&) = delete;

    // late: the newest readback, or null; read during run() only.
    const TileScheduleResult& run(const View& view, const Sight& sight, const SelectionResult& selection,
                                  const GroundReadback* late) {
        return schedule_.run(seen_.see(view, sight, selection, late));
    }
    // As TileSchedule has it.
    void choose_made(std::optional<double> pixel_error_px) { schedule_.choose_made(pixel_error_px); }
    const TileScheduleResult& result() const { return schedule_.result(); }
    const TileTree& tree() const { return schedule_.tree(); }
    const GroundLattice& lattice() const { return seen_.lattice(); }

  private:
    GroundBounds bounds_;
    SeenGround seen_;
    TileSchedule schedule_;
};

}  // namespace ridgeline::select
