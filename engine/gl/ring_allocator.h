// Where in a ring of bytes the next upload may go, and when its place is free again. No GL: testable
// arithmetic.
//
// Allocations are contiguous; one that does not fit before the ring's end starts over at its beginning, and
// the rest of the end is lost until it comes round. Positions count up for ever; their place in the ring is
// position % size.
#pragma once

#include <cstdint>
#include <optional>

namespace ridgeline::gl {

class RingAllocator {
  public:
    explicit RingAllocator(std::uint64_t size_bytes) : size_(size_bytes) {}

    // The offset of `bytes` free bytes, a multiple of `alignment` (any positive number that divides the
    // ring's size), or nothing when they are not free.
    std::optional<std::uint64_t> allocate(std::uint64_t bytes, std::uint64_t alignment);
    // Everything allocated so far ends here; pass it to release() when it is no longer in use.
    std::uint64_t position() const { return head_; }
    // Frees all that was allocated before `position`.
    void release(std::uint64_t position);

    std::uint64_t size_bytes() const { return size_; }
    std::uint64_t used_bytes() const { return head_ - tail_; }

  private:
    std::uint64_t size_;
    std::uint64_t head_ = 0;
    std::uint64_t tail_ = 0;
};

}  // namespace ridgeline::gl
