// The quadtree's level matrix as it was drawn, for whoever looks at it: read back some frames later, waited
// for never.
//
// Render thread only; nothing allocates once the most blocks have been seen.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ridgeline/gl/readback_ring.h"
#include "ridgeline/render/quadtree_blocks.h"

namespace ridgeline::render {

// Of one frame. cells: kQuadtreeEntries of each block, row by row; those that a block does not draw say
// nothing.
struct LevelMatrix {
    shaders::QuadtreeUniforms view{};
    std::vector<shaders::QuadtreeBlock> blocks;
    std::vector<shaders::QuadtreeCell> cells;
};

class LevelMatrixReader {
  public:
    static Result<LevelMatrixReader> create();

    // Of a frame that was just divided. cells: on the GPU. Of more blocks than kMostBlocks the finest are
    // left out.
    void request(const shaders::QuadtreeUniforms& view, const QuadtreeBlocks& blocks,
                 const gl::Buffer& cells);
    // The newest that has arrived; null before the first.
    const LevelMatrix* newest();

    static constexpr std::size_t kMostBlocks = 8192;

  private:
    static constexpr std::size_t kInFlight = 4;

    gl::ReadbackRing ring_;
    // Their cells are on the way; by request.
    std::array<LevelMatrix, kInFlight> asked_;
    std::uint64_t requests_ = 0;
    std::optional<LevelMatrix> newest_;
};

}  // namespace ridgeline::render
