#include "ridgeline/pager/victims.h"

namespace ridgeline::pager {

void VictimSearch::restart(Residency& residency, const Wants& wants) {
    residency.restart(cache_);
    found_in_walk_ = false;
    least_wanted_ = wants.nodes.size();
}

bool VictimSearch::evictable(const Residency& residency, const Wants& wants, const TileEntry& entry) const {
    if (entry.id.level == 0 || entry.last_used_frame + 1 >= wants.frame) return false;
    if (cache_ == AgeWalk::ram) return entry.block && residency.descendants_in_ram(entry.node) == 0;
    return gpu_walk(entry.kind) == cache_ && entry.state == TileState::resident &&
           residency.descendants_on_gpu(entry.node) == 0;
}

TileEntry* VictimSearch::next(Residency& residency, const Wants& wants, std::uint32_t priority) {
    if (TileEntry* entry = next_unwanted(residency, wants)) return entry;
    return next_least_wanted(residency, wants, priority);
}

// Tiles on their way that nobody wants were cancelled, or are with a worker and cannot be.
TileEntry* VictimSearch::next_unwanted(Residency& residency, const Wants& wants) {
    for (;;) {
        while (TileEntry* entry = residency.step(cache_)) {
            if (entry->wanted_stamp == wants.stamp || entry->state == TileState::queued) continue;
            if (!evictable(residency, wants, *entry)) continue;
            found_in_walk_ = true;
            return entry;
        }
        // Those that were kept for descendants may have none by now.
        if (!found_in_walk_) return nullptr;
        found_in_walk_ = false;
        residency.restart(cache_);
    }
}

// Ancestors come before descendants in the wants, so backwards nothing is overlooked.
TileEntry* VictimSearch::next_least_wanted(Residency& residency, const Wants& wants, std::uint32_t priority) {
    while (least_wanted_ > priority + std::size_t{1}) {
        TileEntry* entry = residency.find(wants.nodes[--least_wanted_]);
        if (entry && evictable(residency, wants, *entry)) return entry;
    }
    return nullptr;
}

}  // namespace ridgeline::pager
