// What terrain engines did before data stayed on the GPU, the scheduling paper's "CPU": the level of detail
// is chosen on the CPU, and everything that a frame shows is sent to the GPU anew in every frame.
//
// Sent are, of every chunk that is drawn, vertices, indices, mask and normals, in the store's GPU format, a
// quarter of them for each of its quarters that is drawn; and of the imagery, every tile that the frame
// samples, mip and gutter included. Chosen are they as ever, with nothing left out behind the horizon.
// Nothing is kept for the next frame.
//
// The bytes really go to the GPU, into memory that nothing draws from: the frame itself is drawn from the
// cache, so that the picture is the same and the difference in time is what sending costs. Of imagery the
// bytes are right in number alone, for the CPU's copies may have left memory.
//
// Render thread, with a GL context current.
#pragma once

#include <cstdint>
#include <vector>

#include "ridgeline/app/walk/stage.h"
#include "ridgeline/base/result.h"
#include "ridgeline/gl/buffer.h"
#include "ridgeline/gl/texture.h"

namespace ridgeline::app {

// To the GPU.
struct SentBytes {
    std::int64_t imagery = 0;
    std::int64_t heights = 0;

    std::int64_t all() const { return imagery + heights; }
};

class CpuLod {
  public:
    static Result<CpuLod> create();

    // Sends what the stage's last frame showed.
    SentBytes send(const TerrainStage& stage);

  private:
    CpuLod() = default;
    std::int64_t send_chunk(const TerrainStage& stage, const select::DrawEntry& entry);
    void write(std::span<const std::byte> bytes);
    void send_tile();

    gl::Buffer geometry_;
    std::uint64_t written_ = 0;  // of geometry_, since its beginning was written last
    gl::Texture2D texture_;
    std::vector<std::byte> tile_;
};

}  // namespace ridgeline::app
