// The vertices of scales 1, 2 and 4 that nodes larger than a block need: few, so kept in memory by block.
//
// Thread rules: set for different blocks from any threads; find from any after that.
#pragma once

#include <cstdint>
#include <vector>

#include "ridgeline/build/block_levels.h"
#include "ridgeline/build/block_window.h"
#include "ridgeline/build/blocks.h"

namespace ridgeline::build {

struct FineVertex {
    std::uint32_t place = 0;  // row-major in the block
    std::int32_t quanta = 0;
    std::uint8_t level = 0;  // the coarsest that holds it
};

class FineVertices {
  public:
    explicit FineVertices(const BlockGrid& blocks)
        : blocks_(blocks), by_block_(static_cast<std::size_t>(blocks.count())) {}

    // Keeps what levels above the blocks' top hold, and on the blocks' borders what the top level holds:
    // nodes' fans are made of the next finer level. Blocks at the raster's end reach a little further, as
    // errors do.
    void set(std::int64_t block, const BlockWindow& window, const BlockLevels& levels);
    // Null where no coarse level holds the vertex.
    const FineVertex* find(io::LatticePoint point) const;

  private:
    BlockGrid blocks_;
    std::vector<std::vector<FineVertex>> by_block_;
};

}  // namespace ridgeline::build
