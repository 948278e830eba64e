// Who leaves a cache when room is needed: first what nobody wants, oldest first; then what is wanted least,
// if it is wanted less than what the room is for. Never what the last frame used, what has descendants in the
// same cache, or level 0. Internal to the pager; render thread.
#pragma once

#include <cstdint>
#include <span>

#include "ridgeline/pager/residency.h"

namespace ridgeline::pager {

// What the frame asks for, against which victims are chosen.
struct Wants {
    std::span<const NodeIndex> nodes;  // most urgent first
    std::uint32_t stamp = 0;           // of the entries that are wanted
    std::uint32_t frame = 0;
};

class VictimSearch {
  public:
    explicit VictimSearch(AgeWalk cache) : cache_(cache) {}

    // Begins anew: after the wants or the uses changed.
    void restart(Residency& residency, const Wants& wants);
    // The next to go for something of this priority (its place in the wants), or null. The caller removes it,
    // or leaves it where that cannot be; either way it is not offered again before restart().
    TileEntry* next(Residency& residency, const Wants& wants, std::uint32_t priority);

  private:
    bool evictable(const Residency& residency, const Wants& wants, const TileEntry& entry) const;
    TileEntry* next_unwanted(Residency& residency, const Wants& wants);
    TileEntry* next_least_wanted(Residency& residency, const Wants& wants, std::uint32_t priority);

    AgeWalk cache_;
    bool found_in_walk_ = false;
    std::size_t least_wanted_ = 0;  // the wants from here on have been offered
};

}  // namespace ridgeline::pager
