// Imagery encoded on the GPU, for `build --gpu`: a thread of its own has the GL context and takes what the
// builder's workers bring, as many squares at once as there are.
//
//   workers: encode() ─► queue ─► the encoder's thread: texels ─► GPU ─► blocks ─► workers go on
//
// Thread rules: encode() from any thread, several at once; each waits for its own blocks.
#pragma once

#include <condition_variable>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "ridgeline/base/result.h"
#include "ridgeline/base/thread_annotations.h"
#include "ridgeline/base/units.h"
#include "ridgeline/build/imagery/image_encoder.h"
#include "ridgeline/gpu_encoder/block_encoder.h"

namespace ridgeline::build {

class GpuEncoder final : public ImageEncoder {
  public:
    // Errors: no OpenGL 4.5, no memory on the GPU.
    static Result<std::unique_ptr<GpuEncoder>> create();
    // After the last encode() has returned.
    ~GpuEncoder() override;
    GpuEncoder(const GpuEncoder&) = delete;
    GpuEncoder& operator=(const GpuEncoder&) = delete;

    Result<void> encode(std::span<const Texel> texels, int side, std::span<io::Bc1Block> blocks) override;

    // The driver's part and the buffers: 76 MiB were seen with llvmpipe (Mesa 22.3).
    std::uint64_t memory_bytes() const override { return 96_MiB; }

    // What draws: GL's name of it.
    const std::string& renderer() const { return renderer_; }

  private:
    struct Request {
        std::span<const Texel> texels;
        int side = 0;
        std::span<io::Bc1Block> blocks;
        std::optional<Result<void>> done;
    };
    GpuEncoder() = default;
    // The thread's: opens the context, says how that went, serves until the end.
    void run();
    void serve(BlockEncoder& encoder);
    std::vector<Request*> take();
    Result<void> encode(BlockEncoder& encoder, std::span<Request* const> requests);

    std::string renderer_;
    Mutex mutex_;
    std::condition_variable_any changed_;
    std::optional<Result<void>> opened_ RIDGELINE_GUARDED_BY(mutex_);
    std::vector<Request*> queue_ RIDGELINE_GUARDED_BY(mutex_);
    bool ending_ RIDGELINE_GUARDED_BY(mutex_) = false;
    std::thread thread_;
};

}  // namespace ridgeline::build
