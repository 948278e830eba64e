// A range of work shared out among threads: the inside of parallel_for.
//
// The range is cut into units of one grain and dealt out in equal parts. Each participant takes units one by
// one from the front of its own part and, when that is empty, takes the back half of another's. A part is one
// atomic word, so both are single compare-and-swaps, and a participant that never comes costs nothing: its
// part is taken by others.
//
// Owned and reused by the job system. A late helper, whose loop has ended or whose range serves another loop
// by now, is turned away at the gate, so the caller waits only for those who are inside.
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
    };
    using Participate = void (*)(ParallelRange& range, int part, void* body);

    // Units are counted in 32 bits.
    static constexpr std::int64_t kMaxUnits = std::int64_t{1} << 31;

    explicit ParallelRange(int max_parts);

    // Caller: opens the range to at most parts - 1 helpers and returns the ticket they need.
    std::uint32_t open(const Shape& shape, int parts, Participate participate, void* body);
    // Caller: works as participant 0 until nothing is left to take.
    void work_as_caller() { participate_(*this, 0, body_); }
    // Helper: takes part if the ticket is still good; returns true if it was the last to leave a closed
    // range.
    bool work_as_helper(std::uint32_t ticket);
    // Caller: turns later helpers away; returns true if none is inside.
    bool close();
    // True when the range is closed and nobody is inside.
    bool settled() const;

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
    bool steal_from(Part& victim, Part& own, std::uint32_t& unit);

    std::unique_ptr<Part[]> parts_;
    int max_parts_;
    int part_count_ = 0;
    Shape shape_;
    Participate participate_ = nullptr;
    void* body_ = nullptr;
    // Ticket (high 32), open flag, helpers that entered, helpers inside; see parallel_range.cpp.
    std::atomic<std::uint64_t> gate_{0};
};

}  // namespace ridgeline::jobs
