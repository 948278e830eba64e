// What turns texels into BC1 blocks: on the CPU, or on the GPU (terrain/build/gpu).
//
// Thread rules: encode() from any thread, several at once.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "ridgeline/base/result.h"
#include "ridgeline/build/imagery/texel_rows.h"
#include "ridgeline/io/imagery_tile.h"

namespace ridgeline::build {

class ImageEncoder {
  public:
    virtual ~ImageEncoder() = default;

    // A square of side² texels, rows from the north, into (side / 4)² blocks; side is a multiple of 4. Texels
    // of alpha 0 become transparent, all others opaque. The same texels give the same block wherever they
    // lie. Errors: a GPU that does not answer.
    virtual Result<void> encode(std::span<const Texel> texels, int side, std::span<io::Bc1Block> blocks) = 0;

    // What it takes for itself, beside the threads that ask.
    virtual std::uint64_t memory_bytes() const { return 0; }
};

// On the CPU, by stb_dxt in its high-quality mode.
std::unique_ptr<ImageEncoder> make_cpu_encoder();

}  // namespace ridgeline::build
