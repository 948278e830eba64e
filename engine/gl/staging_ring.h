// The way of bytes to the GPU: a ring of fixed size, mapped for good, guarded by fences.
//
// A frame allocates, fills, and gives GL the commands that copy from it; end_frame() fences them;
// begin_frame() frees what the GPU has finished with. Nothing here ever waits: a full ring answers "nothing",
// and the upload is tried in the next frame. Render thread only, but the bytes of an allocation may be filled
// by another thread until the command that reads them is given.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "ridgeline/base/result.h"
#include "ridgeline/gl/buffer.h"
#include "ridgeline/gl/fence.h"
#include "ridgeline/gl/ring_allocator.h"

namespace ridgeline::gl {

class StagingRing {
  public:
    // Rounded up to a whole number of kAlignment.
    static Result<StagingRing> create(std::uint64_t size_bytes, const std::string& label = "staging ring");

    struct Allocation {
        std::span<std::byte> bytes;
        std::uint64_t offset_bytes = 0;  // in buffer()
    };
    // Aligned for every use (texel uploads, uniform and storage blocks); nothing when the ring is full.
    std::optional<Allocation> allocate(std::uint64_t size_bytes);

    void begin_frame();
    void end_frame();

    const Buffer& buffer() const { return buffer_; }
    std::uint64_t size_bytes() const { return allocator_.size_bytes(); }
    std::uint64_t used_bytes() const { return allocator_.used_bytes(); }

    // The largest uniform-block alignment that OpenGL lets a driver ask for.
    static constexpr std::uint64_t kAlignment = 256;

  private:
    StagingRing(Buffer buffer, std::uint64_t size_bytes);

    // More frames than this in flight share a fence; drivers queue three or so.
    static constexpr std::size_t kMaxFences = 8;
    struct Fenced {
        Fence fence;
        std::uint64_t position = 0;
    };

    Buffer buffer_;
    RingAllocator allocator_;
    std::array<Fenced, kMaxFences> fenced_;  // a queue: oldest at first_
    std::size_t first_ = 0;
    std::size_t count_ = 0;
    std::uint64_t fenced_position_ = 0;
};

}  // namespace ridgeline::gl
