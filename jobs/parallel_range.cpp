// Sharing a loop out by range stealing.
//
// Literature: Blumofe and Leiserson, "Scheduling multithreaded computations by work stealing" (JACM 46,
// 1999); lazy binary splitting of loops, Tzannes, Caragea, Barua and Vishkin (PPoPP 2010). Both keep the
// unsplit part of a loop where others can take from it. Here no task is made for a piece: what is left of a
// participant's part is one word, [first, last), from which the owner takes a unit in front and a thief the
// back half. A word describes the part completely, so a compare-and-swap that succeeds on a value seen
// earlier is right whatever happened in between.
#include "ridgeline/jobs/parallel_range.h"

#include <algorithm>

namespace ridgeline::jobs {
namespace {

constexpr std::uint32_t kOpen = std::uint32_t{1} << 31;
constexpr std::uint32_t kEntered = std::uint32_t{1} << 16;
constexpr std::uint32_t kEnteredMask = kOpen - kEntered;
constexpr std::uint32_t kInside = 1;
constexpr std::uint32_t kInsideMask = kEntered - 1;

}  // namespace

ParallelRange::ParallelRange(int max_parts) : parts_(new Part[max_parts]), max_parts_(max_parts) {}

int ParallelRange::open(const Shape& shape, int parts, Participate participate, void* body) {
    const std::int64_t units = shape.units();
    RIDGELINE_ASSERT(settled() && parts >= 1 && parts <= max_parts_ && units <= kMaxUnits);
    shape_ = shape;
    participate_ = participate;
    body_ = body;
    for (int part = 0; part < max_parts_; ++part) {
        const auto first = static_cast<std::uint32_t>(units * std::min(part, parts) / parts);
        const auto last = static_cast<std::uint32_t>(units * std::min(part + 1, parts) / parts);
        parts_[part].units.store(pack(first, last), std::memory_order_relaxed);
    }
    gate_.store(kOpen, std::memory_order_release);
    return call_helpers(parts - 1);
}

// A helper arrives before it looks at the gate, and the caller counts arrivals after it opened the gate: one
// that the caller counts as still on its way will find the gate open.
int ParallelRange::call_helpers(int wanted) {
    int coming = on_their_way_.load(std::memory_order_relaxed);
    int called = 0;
    do {
        called = wanted > coming ? wanted - coming : 0;
    } while (!on_their_way_.compare_exchange_weak(coming, coming + called, std::memory_order_acq_rel));
    return called;
}

bool ParallelRange::arrive_as_helper() {
    on_their_way_.fetch_sub(1, std::memory_order_acq_rel);
    int part = 0;
    if (!enter(part)) return false;
    participate_(*this, part, body_);
    return leave();
}

bool ParallelRange::enter(int& part) {
    auto gate = gate_.load(std::memory_order_relaxed);
    do {
        part = static_cast<int>((gate & kEnteredMask) / kEntered) + 1;
        if ((gate & kOpen) == 0 || part >= max_parts_) return false;
    } while (!gate_.compare_exchange_weak(gate, gate + kEntered + kInside, std::memory_order_acq_rel));
    return true;
}

bool ParallelRange::leave() {
    const auto before = gate_.fetch_sub(kInside, std::memory_order_acq_rel);
    return (before & kOpen) == 0 && (before & kInsideMask) == kInside;
}

bool ParallelRange::close() {
    return (gate_.fetch_and(~kOpen, std::memory_order_acq_rel) & kInsideMask) == 0;
}

bool ParallelRange::settled() const {
    return (gate_.load(std::memory_order_acquire) & (kOpen | kInsideMask)) == 0;
}

bool ParallelRange::steal(int part, std::uint32_t& unit) {
    for (int step = 1; step < max_parts_; ++step)
        if (steal_from((part + step) % max_parts_, part, unit)) return true;
    return false;
}

bool ParallelRange::steal_from(int victim, int part, std::uint32_t& unit) {
    auto& theirs = parts_[victim].units;
    auto units = theirs.load(std::memory_order_relaxed);
    while (first_of(units) < last_of(units)) {
        const auto first = first_of(units);
        const auto last = last_of(units);
        const auto middle = first + (last - first) / 2;
        if (!theirs.compare_exchange_weak(units, pack(first, middle), std::memory_order_relaxed)) continue;
        // The thief works on the first stolen unit at once, so every theft is progress.
        unit = middle;
        parts_[part].units.store(pack(middle + 1, last), std::memory_order_relaxed);
        return true;
    }
    return false;
}

}  // namespace ridgeline::jobs
