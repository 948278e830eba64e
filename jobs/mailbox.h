// A newest-wins mailbox: one producer thread leaves messages, one consumer thread finds the newest; older
// ones that were not taken in time are overwritten.
//
// A triple buffer: the producer owns one value, the consumer another, the third changes hands by one atomic
// exchange. Neither end ever waits or allocates. Values are reused, not cleared, so a vector in T keeps its
// capacity: the producer must set every field of the draft before it publishes.
#pragma once

#include <atomic>
#include <cstdint>

namespace ridgeline::jobs {

template <class T>
class Mailbox {
  public:
    Mailbox() = default;
    Mailbox(const Mailbox&) = delete;
    Mailbox& operator=(const Mailbox&) = delete;

    // Before either end uses it: visits every value, to size it.
    template <class Visit>
    void for_each_value(Visit visit) {
        for (Slot& slot : slots_) visit(slot.value);
    }

    // Producer: the value to fill; holds some older message. Valid until publish().
    T& draft() { return slots_[draft_].value; }

    // Producer: hands the draft over; the message before it is lost if it was not taken.
    void publish() {
        const auto old =
            middle_.exchange(static_cast<std::uint8_t>(draft_ | kFresh), std::memory_order_acq_rel);
        draft_ = static_cast<std::uint8_t>(old & kIndex);
    }

    // Consumer: the newest message, or null if none came since the last call. What the last successful call
    // returned stays valid, and is the consumer's to change, until the next successful one.
    T* take() {
        if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0) return nullptr;
        held_ = static_cast<std::uint8_t>(middle_.exchange(held_, std::memory_order_acq_rel) & kIndex);
        return &slots_[held_].value;
    }

  private:
    static constexpr std::uint8_t kIndex = 3;
    static constexpr std::uint8_t kFresh = 4;

    // One cache line each, so that the ends do not disturb each other.
    struct alignas(64) Slot {
        T value{};
    };
    Slot slots_[3];
    alignas(64) std::uint8_t draft_ = 0;
    alignas(64) std::uint8_t held_ = 1;
    alignas(64) std::atomic<std::uint8_t> middle_{2};
};

}  // namespace ridgeline::jobs
