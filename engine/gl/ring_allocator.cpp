#include "ridgeline/gl/ring_allocator.h"

#include "ridgeline/base/contract.h"

namespace ridgeline::gl {

std::optional<std::uint64_t> RingAllocator::allocate(std::uint64_t bytes, std::uint64_t alignment) {
    RIDGELINE_CHECK(alignment > 0 && size_ % alignment == 0);
    if (bytes > size_) return std::nullopt;
    // The ring's size is a multiple of the alignment, so an aligned position has an aligned place.
    std::uint64_t begin = (head_ + alignment - 1) / alignment * alignment;
    const std::uint64_t place = begin % size_;
    if (place + bytes > size_) begin += size_ - place;
    // An empty ring owes nothing to the bytes skipped.
    const std::uint64_t tail = tail_ == head_ ? begin : tail_;
    if (begin + bytes - tail > size_) return std::nullopt;
    tail_ = tail;
    head_ = begin + bytes;
    return begin % size_;
}

void RingAllocator::release(std::uint64_t position) {
    RIDGELINE_CHECK(position >= tail_ && position <= head_);
    tail_ = position;
}

}  // namespace ridgeline::gl
