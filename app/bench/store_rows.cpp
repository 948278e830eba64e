#include "ridgeline/app/bench/store_rows.h"

#include <algorithm>

namespace ridgeline::app {

StoreRows::StoreRows(const io::Store& store) : store_(store) {
    const io::TerrainInfo& from = store.info();
    info_.crs_wkt = from.crs_wkt;
    info_.west_m = from.west_m;
    info_.north_m = from.north_m;
    info_.spacing_x_m = from.spacing_x_m;
    info_.spacing_y_m = from.spacing_y_m;
    info_.width = from.width;
    info_.height = from.height;
    info_.quantum_m = from.quantum_m;
    info_.height_offset_m = from.height_offset_m;
    info_.sources = from.sources;
    info_.notes = from.notes;
}

Result<void> StoreRows::read(std::int64_t row, std::int64_t rows, std::span<std::int32_t> quanta) {
    const io::Grid& grid = store_.grid();
    for (std::int64_t i = 0; i < rows; ++i) {
        const auto node_row = static_cast<std::int32_t>(
            std::min<std::int64_t>((row + i) / grid.quads(), grid.nodes_y(grid.finest()) - 1));
        RIDGELINE_TRY(load_band(node_row));
        const std::int64_t in_band = row + i - std::int64_t{node_row} * grid.quads();
        std::copy_n(band_.begin() + in_band * info_.width, info_.width, quanta.begin() + i * info_.width);
    }
    return {};
}

Result<void> StoreRows::load_band(std::int32_t node_row) {
    if (node_row == loaded_) return {};
    const io::Grid& grid = store_.grid();
    band_.assign(static_cast<std::size_t>((grid.quads() + 1) * info_.width), build::kNoHeight);
    for (std::int32_t x = 0; x < grid.nodes_x(grid.finest()); ++x) {
        const io::NodeId node{grid.finest(), x, node_row};
        if (!store_.record(node).has_data()) continue;
        RIDGELINE_TRY(store_.read_heights(node, bytes_, tile_));
        take_tile(std::int64_t{x} * grid.quads());
    }
    loaded_ = node_row;
    return {};
}

void StoreRows::take_tile(std::int64_t first_column) {
    const auto columns =
        static_cast<int>(std::min<std::int64_t>(tile_.quads + 1, info_.width - first_column));
    for (int row = 0; row <= tile_.quads; ++row)
        for (int column = 0; column < columns; ++column) {
            const std::size_t from = tile_.at(column, row);
            if (tile_.all_valid || tile_.sample_valid[from] != 0)
                band_[static_cast<std::size_t>(row * info_.width + first_column + column)] =
                    tile_.quanta[from];
        }
}

}  // namespace ridgeline::app
