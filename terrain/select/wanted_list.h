// The wanted tiles of a frame, most urgent first. Internal to the room.
//
// A tile is one 64-bit key (urgency above, place below), so that ordering is a sort of plain integers:
// extension after visible, coarse before fine, larger error first, then linear order, which makes it the same
// on every run.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "ridgeline/select/frame_tree.h"
#include "ridgeline/select/selection.h"

namespace ridgeline::select {

class WantedList {
  public:
    explicit WantedList(std::size_t capacity) : capacity_(capacity) {
        keys_.reserve(capacity);
        tiles_.reserve(capacity);
    }

    void clear() { keys_.clear(); }
    // error_px is not negative.
    void add(NodeIndex index, int level, bool visible, double error_px) {
        const std::uint64_t urgency = (visible ? 0u : 1u << 31) |
                                      static_cast<std::uint32_t>(level) << kErrorBits |
                                      (kErrorMask - error_bits(error_px));
        keys_.push_back(urgency << 32 | index);
    }
    std::size_t size() const { return keys_.size(); }

    // Sorts, cuts to the capacity, and says of each whether it is resident.
    std::span<const WantedTile> finish(const FrameTree& tree) {
        if (keys_.size() > capacity_) {
            const auto end = keys_.begin() + static_cast<std::ptrdiff_t>(capacity_);
            std::nth_element(keys_.begin(), end, keys_.end());
            keys_.erase(end, keys_.end());
        }
        std::sort(keys_.begin(), keys_.end());
        tiles_.clear();
        for (const std::uint64_t key : keys_) tiles_.push_back(tile(key, tree));
        return tiles_;
    }

  private:
    // A float's bits order as the numbers do; five of its lowest and the sign make room for the level.
    static constexpr int kErrorBits = 26;
    static constexpr std::uint32_t kErrorMask = (1u << kErrorBits) - 1;
    static std::uint32_t error_bits(double error_px) {
        return std::bit_cast<std::uint32_t>(static_cast<float>(error_px)) >> 5 & kErrorMask;
    }
    static WantedTile tile(std::uint64_t key, const FrameTree& tree) {
        const auto index = static_cast<NodeIndex>(key);
        const auto urgency = static_cast<std::uint32_t>(key >> 32);
        return {index, (urgency >> 31) == 0, tree.has(index, FrameTree::kResident),
                std::bit_cast<float>((kErrorMask - (urgency & kErrorMask)) << 5)};
    }

    std::size_t capacity_;
    std::vector<std::uint64_t> keys_;
    std::vector<WantedTile> tiles_;
};

}  // namespace ridgeline::select
