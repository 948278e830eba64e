// Blocks: the squares of finest cells that jobs work on, each the area of whole nodes of its levels.
#pragma once

#include <algorithm>
#include <cstdint>

#include "ridgeline/io/grid.h"

namespace ridgeline::build {

// Cells along a block's side. Large enough that aprons cost little (a fifth), small enough that one
// thread's arrays stay near its second-level cache.
constexpr int kBlock = 512;
// Samples beyond the block that a window holds: 16 for errors and tiles' aprons, 8 more for the fill under
// them.
constexpr int kWindowApron = 24;
constexpr int kWindow = kBlock + 2 * kWindowApron + 1;

// Blocks in rows from the raster's north-western corner; the last ones may reach past it.
class BlockGrid {
  public:
    explicit BlockGrid(const io::Grid& grid)
        : columns_((grid.width() - 2) / kBlock + 1), rows_((grid.height() - 2) / kBlock + 1) {
        while (top_level_ < grid.finest() && grid.extent(top_level_) > kBlock) ++top_level_;
    }

    std::int64_t columns() const { return columns_; }
    std::int64_t rows() const { return rows_; }
    std::int64_t count() const { return columns_ * rows_; }
    // The coarsest level whose nodes lie within blocks.
    int top_level() const { return top_level_; }
    // The block of a lattice point; points beyond the last block belong to it.
    std::int64_t block_of(io::LatticePoint point) const {
        return std::min(point.y / kBlock, rows_ - 1) * columns_ + std::min(point.x / kBlock, columns_ - 1);
    }
    io::LatticePoint origin(std::int64_t block) const {
        return {block % columns_ * kBlock, block / columns_ * kBlock};
    }
    // The last block of a row or column owns its eastern or southern border as well.
    bool last_column(std::int64_t block) const { return block % columns_ == columns_ - 1; }
    bool last_row(std::int64_t block) const { return block / columns_ == rows_ - 1; }

  private:
    std::int64_t columns_, rows_;
    int top_level_ = 0;
};

// Calls visit(node) for the existing nodes of a level that lie in the block.
template <class Visit>
void for_each_node(const io::Grid& grid, io::LatticePoint block_origin, int level, Visit&& visit) {
    const std::int64_t extent = grid.extent(level);
    const auto first_x = static_cast<std::int32_t>(block_origin.x / extent);
    const auto first_y = static_cast<std::int32_t>(block_origin.y / extent);
    const auto nodes = static_cast<std::int32_t>(kBlock / extent);
    for (std::int32_t y = first_y; y < std::min(first_y + nodes, grid.nodes_y(level)); ++y)
        for (std::int32_t x = first_x; x < std::min(first_x + nodes, grid.nodes_x(level)); ++x)
            visit(io::NodeId{level, x, y});
}

}  // namespace ridgeline::build
