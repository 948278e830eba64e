#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <random>
#include <thread>
#include <vector>

#include "jobs_fixture.h"

namespace ridgeline::jobs {
namespace {

using test::on_job_systems;

bool each_once(const std::vector<std::atomic<int>>& calls) {
    return std::ranges::all_of(calls, [](const auto& count) { return count == 1; });
}

TEST_CASE("parallel_for calls its body once for each index, whatever the range and grain") {
    on_job_systems([](JobSystem& jobs) {
        std::mt19937 random(7);
        for (int round = 0; round < 300; ++round) {
            const std::int64_t begin = static_cast<std::int64_t>(random() % 2001) - 1000;
            const std::int64_t count = random() % (round % 10 == 0 ? 5000 : 40);
            const std::int64_t grain = 1 + random() % (round % 3 == 0 ? 100 : 4);
            CAPTURE(begin);
            CAPTURE(count);
            CAPTURE(grain);
            std::vector<std::atomic<int>> calls(static_cast<std::size_t>(count));
            jobs.parallel_for(begin, begin + count, grain,
                              [&](std::int64_t index) { ++calls[static_cast<std::size_t>(index - begin)]; });
            REQUIRE(each_once(calls));
        }
    });
}

TEST_CASE("parallel_for_ranges hands out disjoint ranges of at most one grain that cover all") {
    on_job_systems([](JobSystem& jobs) {
        for (const std::int64_t count : {1, 2, 63, 64, 65, 1000, 4097}) {
            for (const std::int64_t grain : {1, 2, 7, 64, 5000}) {
                std::vector<std::atomic<int>> calls(static_cast<std::size_t>(count));
                std::atomic<int> oversized{0};
                jobs.parallel_for_ranges(0, count, grain, [&](std::int64_t first, std::int64_t last) {
                    oversized += last - first > grain || first >= last ? 1 : 0;
                    for (auto index = first; index < last; ++index) ++calls[static_cast<std::size_t>(index)];
                });
                REQUIRE(each_once(calls));
                REQUIRE(oversized == 0);
            }
        }
    });
}

TEST_CASE("an empty or reversed range calls nothing") {
    JobSystem jobs({.workers = 2});
    int calls = 0;
    jobs.parallel_for(5, 5, 1, [&calls](std::int64_t) { ++calls; });
    jobs.parallel_for(5, -5, 1, [&calls](std::int64_t) { ++calls; });
    CHECK(calls == 0);
}

TEST_CASE("more grains than 32 bits can count are handed out all the same") {
    JobSystem jobs({.workers = 1});
    static constexpr std::int64_t kFirst = std::int64_t{1} << 40;
    static constexpr std::int64_t kGrain = std::int64_t{1} << 30;
    static constexpr std::int64_t kCount = (std::int64_t{1} << 50) + 1;
    std::atomic<std::int64_t> items{0};
    std::atomic<int> calls{0};
    jobs.parallel_for_ranges(kFirst, kFirst + kCount, kGrain, [&](std::int64_t first, std::int64_t last) {
        items += last - first;
        ++calls;
    });
    CHECK(items == kCount);
    CHECK(calls == kCount / kGrain + 1);
}

TEST_CASE("what the bodies wrote is visible after the loop") {
    on_job_systems([](JobSystem& jobs) {
        std::vector<std::int64_t> squares(3000);
        for (int round = 0; round < 30; ++round) {
            jobs.parallel_for(0, 3000, 3,
                              [&](std::int64_t index) { squares[static_cast<std::size_t>(index)] += index; });
        }
        for (std::int64_t index = 0; index < 3000; ++index)
            REQUIRE(squares[static_cast<std::size_t>(index)] == 30 * index);
    });
}

TEST_CASE("loops nest, in loops and in jobs, and run from several threads at once") {
    on_job_systems([](JobSystem& jobs) {
        std::atomic<int> calls{0};
        const auto nested = [&] {
            jobs.parallel_for(0, 20, 1, [&](std::int64_t outer) {
                jobs.parallel_for(0, outer, 1, [&](std::int64_t) { ++calls; });
            });
        };
        std::thread other([&] {
            for (int round = 0; round < 20; ++round) nested();
        });
        Counter counter;
        for (int round = 0; round < 20; ++round) jobs.submit(nested, &counter);
        for (int round = 0; round < 20; ++round) nested();
        jobs.wait(counter);
        other.join();
        CHECK(calls == 60 * 190);
    });
}

TEST_CASE("bodies may submit jobs and wait for them") {
    on_job_systems([](JobSystem& jobs) {
        std::atomic<int> calls{0};
        jobs.parallel_for(0, 500, 1, [&](std::int64_t) {
            Counter counter;
            jobs.submit([&calls] { ++calls; }, &counter);
            jobs.wait(counter);
        });
        CHECK(calls == 500);
    });
}

TEST_CASE("urgent loops finish while normal jobs hold every worker") {
    on_job_systems([](JobSystem& jobs) {
        std::atomic<int> started{0};
        std::atomic<bool> go{false};
        Counter held;
        for (int worker = 0; worker < jobs.worker_count(); ++worker) {
            jobs.submit(
                [&started, &go] {
                    ++started;
                    while (!go) std::this_thread::yield();
                },
                &held);
        }
        while (started < jobs.worker_count()) std::this_thread::yield();
        std::atomic<int> calls{0};
        for (int round = 0; round < 50; ++round)
            jobs.parallel_for(
                0, 100, 1, [&calls](std::int64_t) { ++calls; }, Priority::urgent);
        CHECK(calls == 5000);
        // The helpers that found no time were called once, not once for each loop.
        CHECK(jobs.statistics().submitted <= static_cast<std::uint64_t>(2 * jobs.worker_count()));
        go = true;
        jobs.wait(held);
    });
}

TEST_CASE("participants of very different speed share a loop to its last unit") {
    on_job_systems([](JobSystem& jobs) {
        static constexpr std::int64_t kItems = 2000;
        const auto slow_thread = std::this_thread::get_id();
        std::atomic<int> slow_calls{0};
        std::atomic<int> calls{0};
        // The caller's first item, if it gets one, holds it until someone else has done all the others.
        jobs.parallel_for(0, kItems, 1, [&](std::int64_t) {
            if (std::this_thread::get_id() == slow_thread && slow_calls++ == 0) {
                while (calls < kItems - 1) std::this_thread::yield();
            }
            ++calls;
        });
        CHECK(calls == kItems);
        CHECK(slow_calls <= 1);
    });
}

}  // namespace
}  // namespace ridgeline::jobs
