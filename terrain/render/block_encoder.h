// BC1 blocks by the GPU: what shaders/lib/bc1.h says of a block, for many at once.
//
// Slots of fixed size lie in mapped memory: whoever has texels writes them into a slot's, gives the slot to the
// render thread, and reads the blocks from it once the render thread has seen the work done. Render thread only, but
// the memory of a slot, which is one thread's at a time.
#pragma once

#include <chrono>
#include <cstddef>
#include <span>

#include "ridgeline/base/result.h"
#include "ridgeline/gl/buffer.h"
#include "ridgeline/gl/program.h"
#include "ridgeline/io/imagery_tile.h"
#include "ridgeline/shaders/shared/bc1_blocks.h"

namespace ridgeline::render {

class BlockEncoder {
  public:
    static Result<BlockEncoder> create(std::size_t slots, std::size_t blocks_per_slot);

    std::size_t slots() const { return slots_; }
    std::size_t blocks_per_slot() const { return blocks_per_slot_; }
    // Mapped for as long as the encoder lives; may be slow to read.
    std::span<shaders::Bc1Texels> texels(std::size_t slot) const;
    std::span<const io::Bc1Block> blocks(std::size_t slot) const;

    // Gives GL the command for the first `count` of a slot's blocks.
    void start(std::size_t slot, std::size_t count);
    // Until all that was started is done and its blocks can be read; an Error where that takes longer.
    Result<void> finish(std::chrono::nanoseconds limit);

  private:
    gl::Program program_;
    gl::Buffer texels_;
    gl::Buffer blocks_;
    std::size_t slots_ = 0;
    std::size_t blocks_per_slot_ = 0;
};

}  // namespace ridgeline::render
