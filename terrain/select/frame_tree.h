// The trees of one frame as flags on nodes. Internal to the room; one owner, one thread.
//
// A node's word holds the number of the frame in which it was last touched, so that a new frame clears
// nothing: words of older frames read as no flags.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "ridgeline/io/grid.h"
#include "ridgeline/select/selection.h"

namespace ridgeline::select {

// A node and its place in linear order, which is not worked out again at every step.
struct Visit {
    io::NodeId node;
    NodeIndex index = 0;
};

inline Visit visit(const io::Grid& grid, io::NodeId node) {
    return {node, static_cast<NodeIndex>(grid.linear(node))};
}

class FrameTree {
  public:
    enum Flag : unsigned {
        kSplit = 1,      // the ideal tree splits it
        kDrawn = 2,      // of the drawn tree
        kInView = 4,     // its area, with its parent's heights, touches the frustum
        kInside = 8,     // ... and lies in it wholly
        kInZone = 16,    // in view or in the extension zone
        kResident = 32,  // as the frame's residency says
        kAhead = 64,     // not of the ideal tree: for where the eye may be soon
        kOpened = 128,   // its children were looked at
        kParted = 256,   // the drawn tree splits it
        kAssumed = 512,  // of the drawn tree, in view, not resident: taken to be hidden
        kSeen = 1024,    // not hidden by the horizon
        kSoon = 2048,    // ... or not where the eye may be soon
        kBeside = 4096,  // what the eye stands on or beside, or what that is not drawn fine without
    };

    explicit FrameTree(std::int64_t node_count) : words_(static_cast<std::size_t>(node_count), 0) {}

    void begin_frame() {
        frame_ += 1u << kFlagBits;
        if (frame_ != 0) return;
        // The numbers have come round, after some hours at 60 frames a second.
        std::fill(words_.begin(), words_.end(), 0u);
        frame_ = 1u << kFlagBits;
    }

    // All of `flags` are set.
    bool has(NodeIndex index, unsigned flags) const { return (flags_of(index) & flags) == flags; }
    void add(NodeIndex index, unsigned flags) { words_[index] = frame_ | flags_of(index) | flags; }
    void remove(NodeIndex index, unsigned flags) { words_[index] = frame_ | (flags_of(index) & ~flags); }
    unsigned flags_of(NodeIndex index) const {
        const std::uint32_t word = words_[index];
        return (word & ~kFlagMask) == frame_ ? word & kFlagMask : 0u;
    }

  private:
    static constexpr int kFlagBits = 13;
    static constexpr std::uint32_t kFlagMask = (1u << kFlagBits) - 1;

    std::vector<std::uint32_t> words_;
    std::uint32_t frame_ = 0;
};

}  // namespace ridgeline::select
