// Which layers of a texture array are free. The first are level 0's, one a root, and never leave.
//
// Whatever is in the page table may be sampled by any frame, so a released layer is given out again when the
// GPU has finished the last frame that was drawn before. No GL; after construction nothing allocates.
#pragma once

#include <cstdint>
#include <vector>

#include "ridgeline/base/contract.h"
#include "ridgeline/render/slot_plan.h"

namespace ridgeline::render {

class LayerSlots {
  public:
    explicit LayerSlots(const SlotShape& shape) {
        free_.reserve(static_cast<std::size_t>(shape.slots));
        released_.reserve(static_cast<std::size_t>(shape.slots));
        for (int layer = shape.layers(); layer-- > shape.roots;)
            free_.push_back(static_cast<std::uint32_t>(layer));
    }

    // Takes back what the GPU has finished with.
    void begin_frame(std::uint32_t completed_frame) {
        completed_frame_ = completed_frame;
        std::erase_if(released_, [this](const Released& released) {
            if (released.frame > completed_frame_) return false;
            free_.push_back(released.layer);
            return true;
        });
    }

    bool full() const { return free_.empty(); }
    // A layer was released and is still in use by the GPU.
    bool room_is_coming() const { return !released_.empty(); }
    int free_count() const { return static_cast<int>(free_.size()); }

    // The layer that take() will give; where there is one.
    std::uint32_t next() const {
        RIDGELINE_CHECK(!full());
        return free_.back();
    }
    std::uint32_t take() {
        const std::uint32_t layer = next();
        free_.pop_back();
        return layer;
    }
    // frame: the last that could sample it.
    void release(std::uint32_t layer, std::uint32_t frame) {
        if (frame <= completed_frame_)
            free_.push_back(layer);
        else
            released_.push_back({layer, frame});
    }

  private:
    struct Released {
        std::uint32_t layer = 0;
        std::uint32_t frame = 0;
    };
    std::vector<std::uint32_t> free_;
    std::vector<Released> released_;  // that the GPU may still read
    std::uint32_t completed_frame_ = 0;
};

}  // namespace ridgeline::render
