#include "ridgeline/gl/readback_ring.h"

namespace ridgeline::gl {

Result<ReadbackRing> ReadbackRing::create(const Options& options) {
    RIDGELINE_CHECK(options.slots > 0 && options.slot_bytes > 0);
    ReadbackRing ring;
    // Pixels are packed at multiples of their size; 16 is the largest.
    ring.slot_bytes_ = (options.slot_bytes + 15) / 16 * 16;
    auto buffer = Buffer::create(
        {.size_bytes = ring.slot_bytes_ * options.slots, .use = BufferUse::readback, .label = options.label});
    if (!buffer) return buffer.error();
    ring.buffer_ = std::move(*buffer);
    ring.slots_.resize(options.slots);
    return ring;
}

std::uint64_t ReadbackRing::next_offset_bytes() const {
    return (first_ + count_) % slots_.size() * slot_bytes_;
}

void ReadbackRing::fence_next(std::uint64_t size_bytes, std::uint64_t tag) {
    // Without the barrier a shader's writes need not be seen through the mapping.
    glMemoryBarrier(GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
    slots_[(first_ + count_) % slots_.size()] = {Fence::insert(), tag, size_bytes};
    ++count_;
}

ReadbackRing::Accepted ReadbackRing::request(const Buffer& source, std::uint64_t offset_bytes,
                                             std::uint64_t size_bytes, std::uint64_t tag) {
    RIDGELINE_CHECK(size_bytes <= slot_bytes_);
    if (full()) return Accepted::no;
    copy(source, offset_bytes, buffer_, next_offset_bytes(), size_bytes);
    fence_next(size_bytes, tag);
    return Accepted::yes;
}

ReadbackRing::Accepted ReadbackRing::request(const PixelRegion& region, std::uint64_t tag) {
    RIDGELINE_CHECK(region.size_bytes <= slot_bytes_);
    if (full()) return Accepted::no;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, region.framebuffer);
    glNamedFramebufferReadBuffer(region.framebuffer, region.attachment);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer_.id());
    // GL takes the offset into the bound buffer in the guise of a pointer.
    glReadnPixels(region.origin_px.x, region.origin_px.y, region.size_px.x, region.size_px.y, region.format,
                  region.type, static_cast<GLsizei>(region.size_bytes),
                  reinterpret_cast<void*>(next_offset_bytes()));
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    fence_next(region.size_bytes, tag);
    return Accepted::yes;
}

std::optional<ReadbackRing::Arrived> ReadbackRing::take() {
    if (count_ == 0 || !slots_[first_].fence.passed()) return std::nullopt;
    const Slot slot = std::exchange(slots_[first_], Slot{});
    const auto bytes = buffer_.mapped().subspan(first_ * slot_bytes_, slot.size_bytes);
    first_ = (first_ + 1) % slots_.size();
    --count_;
    return Arrived{slot.tag, bytes};
}

}  // namespace ridgeline::gl
