// BC1 blocks by a compute shader (shaders/lib/bc1.h). Render thread only, with a context; holds GL objects.
#pragma once

#include <cstddef>
#include <span>

#include "ridgeline/base/result.h"
#include "ridgeline/gl/buffer.h"
#include "ridgeline/gl/program.h"
#include "ridgeline/io/imagery_tile.h"
#include "ridgeline/shaders/shared/bc1_blocks.h"

namespace ridgeline::build {

class BlockEncoder {
  public:
    // most_blocks: at a time. Errors: the GPU lacks memory, or the shader fails.
    static Result<BlockEncoder> create(std::size_t most_blocks);

    // Where the next blocks' texels are to be put, most_blocks of them.
    std::span<shaders::Bc1Texels> texels();
    // Of the first `count` of them; waits for the GPU. Until the next call.
    Result<std::span<const io::Bc1Block>> encode(std::size_t count);

  private:
    std::size_t most_blocks_ = 0;
    gl::Program program_;
    gl::Buffer texels_;  // mapped
    gl::Buffer blocks_;
    gl::Buffer arrived_;  // mapped
};

}  // namespace ridgeline::build
