// Cuts a node's heights tile out of a block's window, or out of the coarse lattice where samples lie wider.
#pragma once

#include "ridgeline/build/block_window.h"
#include "ridgeline/build/coarse_lattice.h"
#include "ridgeline/io/grid.h"
#include "ridgeline/io/heights_tile.h"

namespace ridgeline::build {

// The step of a level that a window can serve: its apron holds three samples of it. Wider ones come from the
// lattice.
constexpr std::int64_t kMaxWindowStep = 4;

// The tile's memory is reused. The node must lie in the block.
void cut_heights(const io::Grid& grid, io::NodeId node, io::LatticePoint block_origin,
                 const BlockWindow& window, io::HeightsTile& tile);
void cut_heights(const io::Grid& grid, io::NodeId node, const CoarseLattice& lattice, io::HeightsTile& tile);

// Some cell of the node is invalid.
bool needs_mask(const io::HeightsTile& tile);
// Some sample of the node, borders included, is valid.
bool has_samples(const io::Grid& grid, io::NodeId finest_node, io::LatticePoint block_origin,
                 const BlockWindow& window);

}  // namespace ridgeline::build
