// The way of bytes from the GPU: asked for now, taken some frames later, waited for never.
//
// Each request copies into one of a few slots and is fenced; take() hands out the oldest finished one. When
// the GPU lags so far that no slot is free, a request is refused and the frame goes on without. Render thread
// only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ridgeline/base/result.h"
#include "ridgeline/gl/buffer.h"
#include "ridgeline/gl/fence.h"

namespace ridgeline::gl {

class ReadbackRing {
  public:
    struct Options {
        std::uint64_t slot_bytes = 0;
        std::size_t slots = 4;  // frames that the GPU may lag behind
        std::string label = "readback ring";
    };
    static Result<ReadbackRing> create(const Options& options);

    enum class Accepted { no, yes };
    // `tag` comes back with the bytes (the frame's number). size_bytes <= slot_bytes.
    Accepted request(const Buffer& source, std::uint64_t offset_bytes, std::uint64_t size_bytes,
                     std::uint64_t tag);

    struct PixelRegion {
        GLuint framebuffer = 0;
        GLenum attachment = GL_COLOR_ATTACHMENT0;
        glm::ivec2 origin_px{0};
        glm::ivec2 size_px{0};
        GLenum format = GL_RGBA;
        GLenum type = GL_UNSIGNED_BYTE;
        std::uint64_t size_bytes = 0;
    };
    Accepted request(const PixelRegion& region, std::uint64_t tag);

    struct Arrived {
        std::uint64_t tag = 0;
        std::span<const std::byte> bytes;  // until the next call of request()
    };
    // In the order of the requests; nothing when the oldest is not finished. Call until it gives nothing.
    std::optional<Arrived> take();

    std::size_t in_flight() const { return count_; }

  private:
    struct Slot {
        Fence fence;
        std::uint64_t tag = 0;
        std::uint64_t size_bytes = 0;
    };
    bool full() const { return count_ == slots_.size(); }
    std::uint64_t next_offset_bytes() const;
    void fence_next(std::uint64_t size_bytes, std::uint64_t tag);

    Buffer buffer_;
    std::uint64_t slot_bytes_ = 0;
    std::vector<Slot> slots_;  // a queue: oldest at first_
    std::size_t first_ = 0;
    std::size_t count_ = 0;
};

}  // namespace ridgeline::gl
