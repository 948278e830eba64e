// A range of work shared out among threads: the inside of parallel_for.
//
// The range is cut into units of one grain and dealt out in equal parts. Each participant takes units one by
// one from the front of its own part and, when that is empty, takes the back half of another's. A part is one
// atomic word, so both are single compare-and-swaps, and a participant that never comes costs nothing: its
// part is taken by others.
//
// Owned and reused by the job system. Helpers pass a gate that is open only while a loop runs, so the caller
// waits for those who are inside and not for those who are still on their way; these will help the next loop
// instead.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>

#include "ridgeline/base/contract.h"

namespace ridgeline::jobs {

class ParallelRange {
  public:
    // The items [begin, end) in units of `grain` items, the last unit being what is left over.
    struct Shape {
        std::int64_t begin = 0;
        std::int64_t end = 0;
        std::int64_t grain = 1;

        std::int64_t units() const { return (end - begin - 1) / grain + 1; }
    };
    using Participate = void (*)(ParallelRange& range, int part, void* body);

    // Units are counted in 32 bits.
    static constexpr std::int64_t kMaxUnits = std::int64_t{1} << 31;

    explicit ParallelRange(int max_parts);

    // Caller: opens the gate to at most parts - 1 helpers; returns how many must be called, besides those
    // that are on their way from earlier loops.
    int open(const Shape& shape, int parts, Participate participate, void* body);
    // Caller: works as participant 0 until nothing is left to take.
    void work_as_caller() { participate_(*this, 0, body_); }
    // Caller: closes the gate; returns true if nobody is inside.
    bool close();
    // True when the gate is closed and nobody is inside.
    bool settled() const;

    // Helper: arrives and, if the gate is open, takes part; true if it was the last to leave a closed gate.
    // The range may serve another loop by then.
    bool arrive_as_helper();

    // Calls body(first, last) for unit after unit until nothing is left to take.
    template <class Body>
    void consume(int part, Body& body) {
        std::uint32_t unit = 0;
        while (take_own(part, unit) || steal(part, unit)) {
            const std::int64_t first = shape_.begin + unit * shape_.grain;
            const std::int64_t left = shape_.end - first;
            body(first, first + (left < shape_.grain ? left : shape_.grain));
        }
    }

  private:
    // One cache line each: owners must not disturb each other.
    struct alignas(64) Part {
        // First unit in the low half, one past the last in the high half.
        std::atomic<std::uint64_t> units{0};
    };

    static std::uint64_t pack(std::uint32_t first, std::uint32_t last) {
        return first | std::uint64_t{last} << 32;
    }
    static std::uint32_t first_of(std::uint64_t units) { return static_cast<std::uint32_t>(units); }
    static std::uint32_t last_of(std::uint64_t units) { return static_cast<std::uint32_t>(units >> 32); }

    bool take_own(int part, std::uint32_t& unit) {
        auto& own = parts_[part].units;
        auto units = own.load(std::memory_order_relaxed);
        while (first_of(units) < last_of(units)) {
            // Relaxed: a unit carries no data; the body and its captures were published with the gate.
            if (own.compare_exchange_weak(units, units + 1, std::memory_order_relaxed)) {
                unit = first_of(units);
                return true;
            }
        }
        return false;
    }
    bool steal(int part, std::uint32_t& unit);
    bool steal_from(int victim, int part, std::uint32_t& unit);
    bool enter(int& part);
    bool leave();
    int call_helpers(int wanted);

    std::unique_ptr<Part[]> parts_;
    int max_parts_;
    Shape shape_;
    Participate participate_ = nullptr;
    void* body_ = nullptr;
    // Open flag, helpers that entered since it opened, helpers inside.
    std::atomic<std::uint32_t> gate_{0};
    // Helpers called that have not arrived.
    std::atomic<int> on_their_way_{0};
};

}  // namespace ridgeline::jobs
