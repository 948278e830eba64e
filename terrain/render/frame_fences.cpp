#include "ridgeline/render/frame_fences.h"

#include <chrono>

namespace ridgeline::render {

void FrameFences::end_frame(std::uint32_t frame) {
    // A full queue gives this frame the place of the newest, whose commands are done when this one's are.
    if (count_ == kMaxFences) --count_;
    fenced_[(first_ + count_++) % kMaxFences] = {gl::Fence::insert(), frame};
}

void FrameFences::limit(std::size_t frames_in_flight) {
    // A GPU that takes longer is lost; what it still holds back is then told by the next call that fails.
    constexpr std::chrono::seconds kPatience{10};
    while (count_ > frames_in_flight) {
        if (!fenced_[first_].fence.wait(kPatience)) return;
        poll();
    }
}

void FrameFences::poll() {
    while (count_ > 0 && fenced_[first_].fence.passed()) {
        completed_ = fenced_[first_].frame;
        first_ = (first_ + 1) % kMaxFences;
        --count_;
    }
}

}  // namespace ridgeline::render
