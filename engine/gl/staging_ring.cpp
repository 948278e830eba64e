#include "ridgeline/gl/staging_ring.h"

namespace ridgeline::gl {

Result<StagingRing> StagingRing::create(std::uint64_t size_bytes, const std::string& label) {
    const std::uint64_t rounded = (size_bytes + kAlignment - 1) / kAlignment * kAlignment;
    auto buffer = Buffer::create({.size_bytes = rounded, .use = BufferUse::upload, .label = label});
    if (!buffer) return buffer.error();
    return StagingRing(std::move(*buffer), rounded);
}

StagingRing::StagingRing(Buffer buffer, std::uint64_t size_bytes)
    : buffer_(std::move(buffer)), allocator_(size_bytes) {}

std::optional<StagingRing::Allocation> StagingRing::allocate(std::uint64_t size_bytes) {
    const auto offset = allocator_.allocate(size_bytes, kAlignment);
    if (!offset) return std::nullopt;
    return Allocation{buffer_.mapped().subspan(*offset, size_bytes), *offset};
}

void StagingRing::begin_frame() {
    while (count_ > 0 && fenced_[first_].fence.passed()) {
        allocator_.release(fenced_[first_].position);
        fenced_[first_].fence = Fence();
        first_ = (first_ + 1) % kMaxFences;
        --count_;
    }
}

void StagingRing::end_frame() {
    if (allocator_.position() == fenced_position_) return;
    // With all fences in flight, the next frame's fence covers this frame as well.
    if (count_ == kMaxFences) return;
    fenced_position_ = allocator_.position();
    fenced_[(first_ + count_) % kMaxFences] = {Fence::insert(), fenced_position_};
    ++count_;
}

}  // namespace ridgeline::gl
