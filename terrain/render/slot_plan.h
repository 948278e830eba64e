// How the bytes of a GPU cache of tiles are divided: what level 0 and the page table take, and how many slots
// that leaves for all other tiles. Pure arithmetic; any thread.
#pragma once

#include <cstdint>
#include <string>

#include "ridgeline/base/result.h"
#include "ridgeline/pager/tile_source.h"

namespace ridgeline::render {

// Tiles of one kind, as their cache must hold them.
struct SlotDemand {
    std::string store;  // for messages
    const char* layer = "imagery";
    std::uint64_t tile_bytes = 0;
    std::uint64_t table_bytes = 0;
    std::int64_t roots = 0;   // tiles of level 0
    std::int64_t others = 0;  // below it, with data
};
// Of a source with imagery, and of one whose heights are paged.
SlotDemand imagery_demand(const pager::TileSource& source);
// made_octaves: of tiles that are made below the source, as many as there are slots for.
SlotDemand heights_demand(const pager::TileSource& source, int made_octaves = 0);

struct SlotShape {
    std::uint64_t tile_bytes = 0;
    std::uint64_t table_bytes = 0;
    int roots = 0;
    int slots = 0;  // of all other tiles: the scheduling paper's N

    int layers() const { return roots + slots; }
    std::uint64_t total_bytes() const {
        return static_cast<std::uint64_t>(layers()) * tile_bytes + table_bytes;
    }
};

struct SlotOptions {
    std::uint64_t capacity_bytes = 0;
    // Which part of --gpu-cache the capacity is, for the message: one of `parts`.
    std::uint64_t parts = 2;
    int max_layers = 2048;
};
// What level 0 and the page table take.
std::uint64_t least_bytes(const SlotDemand& demand);
// As many slots as fit, have a layer and can ever be filled. Fails where level 0 does not fit, naming the
// least --gpu-cache, or has more tiles than there are layers.
Result<SlotShape> plan_slots(const SlotDemand& demand, const SlotOptions& options);

}  // namespace ridgeline::render
