#include "ridgeline/build/node_heights.h"

#include <algorithm>
#include <bit>

namespace ridgeline::build {
namespace {

constexpr int kApron = io::HeightsTile::kApron;

// flags(column, row) gives a sample's flags, cell_valid(column, row) whether its cell is; counted in the
// tile's step.
template <class Flags, class CellValid>
void set_validity(io::HeightsTile& tile, Flags&& flags, CellValid&& cell_valid) {
    tile.sample_valid.clear();
    tile.cell_valid.clear();
    for (int row = -kApron; row <= tile.quads + kApron; ++row)
        for (int column = -kApron; column <= tile.quads + kApron; ++column)
            tile.sample_valid.push_back((flags(column, row) & sample::kValid) != 0 ? 1 : 0);
    for (int row = 0; row < tile.quads; ++row)
        for (int column = 0; column < tile.quads; ++column)
            tile.cell_valid.push_back(cell_valid(column, row) ? 1 : 0);
    const auto all = [](const std::vector<std::uint8_t>& valid) {
        return std::find(valid.begin(), valid.end(), std::uint8_t{0}) == valid.end();
    };
    tile.all_valid = all(tile.sample_valid) && all(tile.cell_valid);
    if (!tile.all_valid) return;
    tile.sample_valid.clear();
    tile.cell_valid.clear();
}

void resize_quanta(io::HeightsTile& tile) {
    tile.quanta.resize(static_cast<std::size_t>(tile.stride()) * static_cast<std::size_t>(tile.stride()));
}

}  // namespace

void cut_heights(const io::Grid& grid, io::NodeId node, io::LatticePoint block_origin,
                 const BlockWindow& window, io::HeightsTile& tile) {
    const std::int64_t step = grid.step(node.level);
    const std::int64_t x0 = grid.origin(node).x - block_origin.x, y0 = grid.origin(node).y - block_origin.y;
    const auto at = [&](int column, int row) { return BlockWindow::at(x0 + column * step, y0 + row * step); };
    tile.quads = grid.quads();
    resize_quanta(tile);
    for (int row = -kApron; row <= tile.quads + kApron; ++row) {
        const std::int32_t* from = &window.quanta()[at(-kApron, row)];
        std::int32_t* to = &tile.quanta[tile.at(-kApron, row)];
        if (step == 1)
            std::copy_n(from, tile.stride(), to);
        else
            for (int i = 0; i < tile.stride(); ++i) to[i] = from[i * step];
    }
    tile.all_valid = window.complete();
    tile.sample_valid.clear();
    tile.cell_valid.clear();
    if (tile.all_valid) return;
    const auto flags = window.flags();
    const auto cell_valid = [&](int column, int row) {
        std::uint8_t any = 0;
        for (std::int64_t y = 0; y < step; ++y)
            for (std::int64_t x = 0; x < step; ++x)
                any |= flags[at(column, row) + static_cast<std::size_t>(y * kWindow + x)];
        return (any & sample::kCellValid) != 0;
    };
    set_validity(
        tile, [&](int column, int row) { return flags[at(column, row)]; }, cell_valid);
}

void cut_heights(const io::Grid& grid, io::NodeId node, const CoarseLattice& lattice, io::HeightsTile& tile) {
    const int scale = std::countr_zero(static_cast<std::uint64_t>(grid.step(node.level)));
    const std::int64_t x0 = std::int64_t{node.x} * grid.quads(), y0 = std::int64_t{node.y} * grid.quads();
    const auto packed = [&](int column, int row) { return lattice.sample(scale, x0 + column, y0 + row); };
    tile.quads = grid.quads();
    resize_quanta(tile);
    for (int row = -kApron; row <= tile.quads + kApron; ++row)
        for (int column = -kApron; column <= tile.quads + kApron; ++column)
            tile.quanta[tile.at(column, row)] = sample::quanta(packed(column, row));
    set_validity(tile, packed,
                 [&](int column, int row) { return (packed(column, row) & sample::kCellValid) != 0; });
}

bool needs_mask(const io::HeightsTile& tile) {
    return std::find(tile.cell_valid.begin(), tile.cell_valid.end(), std::uint8_t{0}) !=
           tile.cell_valid.end();
}

bool has_samples(const io::Grid& grid, io::NodeId finest_node, io::LatticePoint block_origin,
                 const BlockWindow& window) {
    if (window.complete()) return true;
    const io::LatticePoint origin = grid.origin(finest_node);
    for (int row = 0; row <= grid.quads(); ++row) {
        const auto first =
            window.flags().begin() + static_cast<std::ptrdiff_t>(BlockWindow::at(
                                         origin.x - block_origin.x, origin.y - block_origin.y + row));
        if (std::any_of(first, first + grid.quads() + 1,
                        [](std::uint8_t f) { return (f & sample::kValid) != 0; }))
            return true;
    }
    return false;
}

}  // namespace ridgeline::build
