#include "ridgeline/telemetry/clock.h"

#include <doctest/doctest.h>

#include <atomic>
#include <chrono>
#include <fstream>
#include <optional>
#include <thread>
#include <vector>

namespace ridgeline::telemetry {
namespace {

// Works until this thread has used so much CPU time.
void use_cpu(std::int64_t duration_ns) {
    const auto clock = ThreadCpuClock::of_this_thread();
    const auto end = clock.used_ns() + duration_ns;
    while (clock.used_ns() < end) {
    }
}

constexpr std::int64_t kWorkNs = 5'000'000;

TEST_CASE("the steady clock never runs backwards") {
    auto last = now_ns();
    for (int look = 0; look < 1000; ++look) {
        const auto now = now_ns();
        REQUIRE(now >= last);
        last = now;
    }
}

TEST_CASE("a thread's CPU clock counts the work of that thread alone, and is read from another") {
    const auto here = ThreadCpuClock::of_this_thread();
    std::optional<ThreadCpuClock> there;
    std::atomic<bool> worked{false};
    std::atomic<bool> end{false};
    std::thread worker([&] {
        there = ThreadCpuClock::of_this_thread();
        use_cpu(kWorkNs);
        worked = true;
        while (!end) std::this_thread::yield();
    });
    while (!worked) std::this_thread::yield();
    const auto process_before = process_cpu_ns();
    CHECK(there->used_ns() >= kWorkNs);
    CHECK(process_before >= there->used_ns());
    const auto before = here.used_ns();
    use_cpu(kWorkNs);
    CHECK(here.used_ns() - before >= kWorkNs);
    end = true;
    worker.join();
    // The system may take a moment more to forget a thread that has been joined.
    while (there->used_ns() != 0) std::this_thread::yield();
    CHECK(process_cpu_ns() >= process_before + kWorkNs);
}

TEST_CASE("a thread's waits are those in which it gave its core away, not the work it did") {
    const auto before = waits_of_this_thread();
    // As busy as it is, others may take its core.
    use_cpu(kWorkNs);
    const auto worked = waits_of_this_thread();
    for (int i = 0; i < 10; ++i) std::this_thread::sleep_for(std::chrono::microseconds(100));
    const auto slept = waits_of_this_thread();
    CHECK(worked == before);
    CHECK(slept >= worked + 10);
}

TEST_CASE("resident memory is reported, and its peak covers what was touched") {
    constexpr std::size_t kTouchedBytes = std::size_t{64} << 20;
    const auto before = current_rss_bytes();
    CHECK(before > 0);
    {
        const std::vector<char> touched(kTouchedBytes, 1);
        CHECK(current_rss_bytes() > kTouchedBytes / 2);
        CHECK(touched.back() == 1);
    }
    CHECK(peak_rss_bytes() >= kTouchedBytes);
    CHECK(peak_rss_bytes() + (1 << 20) >= before);
}

}  // namespace
}  // namespace ridgeline::telemetry

TEST_CASE("open handles: one more for each file that is opened, and none is kept by looking") {
    using ridgeline::telemetry::open_handles;
    const auto before = open_handles();
    CHECK(before >= 3);
    {
        const std::ifstream one("/proc/self/status"), other("/proc/self/status");
        CHECK(open_handles() == before + 2);
    }
    CHECK(open_handles() == before);
}
