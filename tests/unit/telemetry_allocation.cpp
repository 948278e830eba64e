#include <doctest/doctest.h>

#include <cstdint>
#include <memory>
#include <new>
#include <thread>

#include "ridgeline/telemetry/allocation_counter.h"
#include "ridgeline/telemetry/recorder.h"

namespace ridgeline::telemetry {
namespace {

struct alignas(256) Aligned {
    char bytes[256] = {};
};

template <class Make>
std::uint64_t allocations_of(Make make) {
    const auto before = heap_allocations_of_this_thread();
    make();
    return heap_allocations_of_this_thread() - before;
}

// Called by name, as new-expressions may be optimised away.
TEST_CASE("every form of operator new is counted") {
    REQUIRE(counts_heap_allocations());
    CHECK(allocations_of([] { ::operator delete(::operator new(10)); }) == 1);
    CHECK(allocations_of([] { ::operator delete[](::operator new[](10)); }) == 1);
    CHECK(allocations_of([] { ::operator delete(::operator new(10, std::nothrow)); }) == 1);
    CHECK(allocations_of([] { ::operator delete(::operator new(0)); }) == 1);
    constexpr auto kAlignment = std::align_val_t(alignof(Aligned));
    CHECK(allocations_of([] { ::operator delete(::operator new(300, kAlignment), kAlignment); }) == 1);
    CHECK(allocations_of([] { ::operator delete[](::operator new[](0, kAlignment), kAlignment); }) == 1);
    CHECK(allocations_of([] {}) == 0);
    const auto aligned = std::make_unique<Aligned>();
    CHECK(reinterpret_cast<std::uintptr_t>(aligned.get()) % alignof(Aligned) == 0);
}

TEST_CASE("allocations of other threads count for the process, not for this thread") {
    const auto here = heap_allocations_of_this_thread();
    const auto everywhere = heap_allocations();
    std::thread([] {
        for (int round = 0; round < 100; ++round) ::operator delete(::operator new(8));
    }).join();
    CHECK(heap_allocations() - everywhere >= 100);
    CHECK(heap_allocations_of_this_thread() - here < 50);
}

TEST_CASE("recording frames, values and scopes allocates nothing in steady state") {
    Recorder recorder;
    Trace* const trace = recorder.trace();
    trace->add_value("first", 0);
    std::int64_t number = 0;
    const auto allocations = allocations_of([&] {
        for (; number < 10'000; ++number) {
            const TraceScope scope(trace, "frame");
            FrameRecord record;
            record.frame = number;
            recorder.add_frame(record);
            recorder.request_to_ready_ns().record(number);
            recorder.tiles().loaded += 1;
            trace->add_value("rss", static_cast<double>(current_rss_bytes()));
        }
    });
    CHECK(allocations == 0);
}

}  // namespace
}  // namespace ridgeline::telemetry
