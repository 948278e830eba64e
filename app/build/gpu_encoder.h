// The imagery's blocks by the GPU, for a build: a thread that owns a GL context and serves whoever makes tiles.
//
// It is the build's render thread, the only one that touches GL. A worker that has a tile's texels writes them into a
// slot of mapped memory and goes on; the render thread takes all slots that came, has the GPU encode them, and calls
// back. Thread rules: open() and the end from one thread; encode() from any.
#pragma once

#include <memory>
#include <string>

#include "ridgeline/base/result.h"
#include "ridgeline/build/imagery/image_encoder.h"

namespace ridgeline::app {

class GpuEncoder : public build::ImageEncoder {
  public:
    // Errors: no OpenGL 4.5 without a window, or too little memory on the GPU.
    static Result<std::unique_ptr<GpuEncoder>> open();

    // As GL names it.
    virtual const std::string& renderer() const = 0;
};

}  // namespace ridgeline::app
