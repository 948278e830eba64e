// Which frames the GPU has finished with; and that the CPU does not run ahead of it for ever.
//
// Render thread only. One fence a frame, a few in flight; where the GPU lags further, frames share a fence.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "ridgeline/gl/fence.h"

namespace ridgeline::render {

class FrameFences {
  public:
    // After the last command of `frame`; frames count upwards.
    void end_frame(std::uint32_t frame);
    // Asks the fences in flight; never waits.
    void poll();
    // Waits until no more frames than these are unfinished.
    void limit(std::size_t frames_in_flight);
    // All commands of this frame and of those before it are done; 0 before the first.
    std::uint32_t completed() const { return completed_; }

  private:
    // Drivers queue three frames or so.
    static constexpr std::size_t kMaxFences = 8;
    struct Fenced {
        gl::Fence fence;
        std::uint32_t frame = 0;
    };
    std::array<Fenced, kMaxFences> fenced_;  // a queue: oldest at first_
    std::size_t first_ = 0;
    std::size_t count_ = 0;
    std::uint32_t completed_ = 0;
};

}  // namespace ridgeline::render
