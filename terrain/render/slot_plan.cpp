#include "ridgeline/render/slot_plan.h"

#include <algorithm>
#include <limits>
#include <span>

#include "ridgeline/detail/finer_ground.h"
#include "ridgeline/render/page_table.h"
#include "ridgeline/shaders/shared/imagery_uniforms.h"

namespace ridgeline::render {
namespace {

// What an entry of the page table can name.
constexpr int kMostLayers = static_cast<int>(shaders::kPageSlotMask);

template <class Record>
std::int64_t below_level0(std::span<const Record> records, std::int64_t roots) {
    return std::ranges::count_if(records.subspan(static_cast<std::size_t>(roots)),
                                 [](const Record& record) { return record.has_data(); });
}

SlotShape level0_alone(const SlotDemand& demand) {
    return {demand.tile_bytes, demand.table_bytes, static_cast<int>(demand.roots), 0};
}

}  // namespace

SlotDemand imagery_demand(const pager::TileSource& source) {
    const io::Grid& grid = source.imagery.grid;
    const std::int64_t roots = grid.first(1);
    return {source.name,
            "imagery",
            io::kImageryTileBytes,
            PageTable::bytes(grid),
            roots,
            below_level0(source.imagery.records, roots)};
}

SlotDemand heights_demand(const pager::TileSource& source, int made_octaves) {
    const std::int64_t roots = source.grid.first(1);
    const std::int64_t others = below_level0(source.records, roots);
    return {source.name,
            "heights",
            pager::heights_texels_bytes(source.grid.quads()),
            PageTable::bytes(source.grid.finer(made_octaves)),
            roots,
            made_octaves > 0 ? std::numeric_limits<std::int64_t>::max() : others};
}

std::uint64_t least_bytes(const SlotDemand& demand) { return level0_alone(demand).total_bytes(); }

Result<SlotShape> plan_slots(const SlotDemand& demand, const SlotOptions& options) {
    const std::string level0 = demand.store + ": the coarsest level of its " + demand.layer;
    const int most_layers = std::min(options.max_layers, kMostLayers);
    if (demand.roots > most_layers)
        return Error{level0 + " is too long and narrow: it has " + std::to_string(demand.roots) +
                     " tiles, of which a texture holds " + std::to_string(most_layers)};
    SlotShape shape = level0_alone(demand);
    if (shape.total_bytes() > options.capacity_bytes)
        return Error{level0 + " does not fit the GPU cache: use --gpu-cache " +
                     std::to_string((shape.total_bytes() * options.parts + 1023) / 1024) + "KiB or more"};
    const std::uint64_t fit = (options.capacity_bytes - shape.total_bytes()) / demand.tile_bytes;
    shape.slots = static_cast<int>(
        std::min({static_cast<std::int64_t>(fit), most_layers - demand.roots, demand.others}));
    return shape;
}

}  // namespace ridgeline::render
