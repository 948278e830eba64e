#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <thread>
#include <vector>

#include "jobs_fixture.h"
#include "ridgeline/base/thread_role.h"

namespace ridgeline::jobs {
namespace {

using test::on_job_systems;
using test::Tracked;

TEST_CASE("every job of several producers runs exactly once") {
    static constexpr int kProducers = 3;
    static constexpr int kJobs = 4000;
    on_job_systems([](JobSystem& jobs) {
        std::vector<std::atomic<int>> runs(kProducers * kJobs);
        std::vector<std::thread> producers;
        for (int producer = 0; producer < kProducers; ++producer) {
            producers.emplace_back([&jobs, &runs, producer] {
                Counter counter;
                for (int job = 0; job < kJobs; ++job)
                    jobs.submit([&run = runs[static_cast<std::size_t>(producer * kJobs + job)]] { ++run; },
                                &counter, job % 7 == 0 ? Priority::urgent : Priority::normal);
                jobs.wait(counter);
            });
        }
        for (auto& producer : producers) producer.join();
        CHECK(std::ranges::all_of(runs, [](const auto& count) { return count == 1; }));
    });
}

TEST_CASE("what jobs wrote is visible after the wait, and their captures are gone") {
    on_job_systems([](JobSystem& jobs) {
        for (int round = 0; round < 50; ++round) {
            std::vector<int> results(64);
            Counter counter;
            for (int job = 0; job < 64; ++job)
                jobs.submit(
                    [&results, job, tracked = Tracked()] { results[static_cast<std::size_t>(job)] = job; },
                    &counter);
            jobs.wait(counter);
            CHECK(Tracked::live() == 0);
            for (int job = 0; job < 64; ++job) REQUIRE(results[static_cast<std::size_t>(job)] == job);
        }
    });
}

TEST_CASE("a counter may be destroyed as soon as its wait returns, or it says that it is done") {
    on_job_systems([](JobSystem& jobs) {
        for (int round = 0; round < 3000; ++round) {
            auto counter = std::make_unique<Counter>();
            jobs.submit([] {}, counter.get());
            if (round % 2 == 0) {
                jobs.wait(*counter);
            } else {
                while (!counter->done()) std::this_thread::yield();
            }
        }
    });
}

TEST_CASE("a wait for a counter without jobs returns at once") {
    JobSystem jobs({.workers = 1});
    Counter counter;
    jobs.wait(counter);
    CHECK(counter.done());
}

std::int64_t fibonacci(JobSystem& jobs, int n) {
    if (n < 2) return n;
    std::int64_t left = 0;
    Counter counter;
    jobs.submit([&jobs, &left, n] { left = fibonacci(jobs, n - 1); }, &counter);
    const std::int64_t right = fibonacci(jobs, n - 2);
    jobs.wait(counter);
    return left + right;
}

TEST_CASE("jobs that wait for their own jobs, recursively, finish with the right result") {
    on_job_systems([](JobSystem& jobs) {
        std::int64_t inside = 0;
        Counter counter;
        jobs.submit([&] { inside = fibonacci(jobs, 16); }, &counter);
        CHECK(fibonacci(jobs, 16) == 987);
        jobs.wait(counter);
        CHECK(inside == 987);
    });
}

TEST_CASE("waits nest no deeper than the recursion, however many jobs wait") {
    // Each of these jobs waits inside; would every wait begin another of them, the stack would not hold them.
    static constexpr int kJobs = 20'000;
    on_job_systems([](JobSystem& jobs) {
        std::atomic<int> leaves{0};
        Counter all;
        for (int job = 0; job < kJobs; ++job) {
            jobs.submit(
                [&jobs, &leaves] {
                    Counter inner;
                    for (int leaf = 0; leaf < 3; ++leaf) jobs.submit([&leaves] { ++leaves; }, &inner);
                    jobs.wait(inner);
                },
                &all);
        }
        jobs.wait(all);
        CHECK(leaves == 3 * kJobs);
    });
}

TEST_CASE("a job may submit more jobs than its stack holds") {
    on_job_systems([](JobSystem& jobs) {
        std::atomic<int> runs{0};
        Counter counter;
        jobs.submit(
            [&] {
                for (int job = 0; job < 1000; ++job)
                    jobs.submit([&runs, tracked = Tracked()] { ++runs; }, &counter,
                                job % 2 == 0 ? Priority::urgent : Priority::normal);
            },
            &counter);
        jobs.wait(counter);
        CHECK(runs == 1000);
    });
}

TEST_CASE("destruction first runs everything, also what jobs submit meanwhile") {
    for (const int workers : test::kWorkerCounts) {
        std::atomic<int> runs{0};
        {
            JobSystem jobs({.workers = workers});
            for (int job = 0; job < 500; ++job) {
                jobs.submit([&jobs, &runs, tracked = Tracked()] {
                    ++runs;
                    jobs.submit([&runs, tracked = Tracked()] { ++runs; });
                });
            }
        }
        CHECK(runs == 1000);
        CHECK(Tracked::live() == 0);
    }
}

TEST_CASE("an urgent job overtakes all normal jobs that wait") {
    JobSystem jobs({.workers = 1});
    std::atomic<bool> started{false};
    std::atomic<bool> go{false};
    std::atomic<int> order{0};
    int urgent_place = -1;
    Counter counter;
    jobs.submit(
        [&] {
            started = true;
            while (!go) std::this_thread::yield();
        },
        &counter);
    while (!started) std::this_thread::yield();
    for (int job = 0; job < 100; ++job) jobs.submit([&] { ++order; }, &counter);
    jobs.submit([&] { urgent_place = order++; }, &counter, Priority::urgent);
    go = true;
    while (!counter.done()) std::this_thread::yield();
    CHECK(urgent_place == 0);
}

TEST_CASE("a thread that helps with urgent jobs only runs no others while it waits") {
    on_job_systems([](JobSystem& jobs) {
        const auto self = std::this_thread::get_id();
        std::atomic<int> normal_here{0};
        for (int round = 0; round < 200; ++round) {
            Counter normal;
            Counter urgent;
            for (int job = 0; job < 20; ++job)
                jobs.submit([&] { normal_here += std::this_thread::get_id() == self ? 1 : 0; }, &normal);
            jobs.submit([] {}, &urgent, Priority::urgent);
            jobs.wait(urgent, Help::urgent_only);
            jobs.wait(normal, Help::urgent_only);
        }
        CHECK(normal_here == 0);
    });
}

TEST_CASE("workers have their role, and the hooks run on them") {
    std::atomic<int> started{0};
    std::atomic<int> stopped{0};
    {
        JobSystem jobs({.workers = 3,
                        .on_worker_start = [&](int worker) { started += worker + 1; },
                        .on_worker_stop = [&](int worker) { stopped += worker + 1; }});
        CHECK(jobs.worker_count() == 3);
        std::atomic<bool> is_worker{false};
        std::atomic<bool> ran{false};
        jobs.submit([&] {
            is_worker = thread_role() == ThreadRole::worker;
            ran = true;
        });
        while (!ran) std::this_thread::yield();
        CHECK(is_worker);
    }
    CHECK(started == 6);
    CHECK(stopped == 6);
}

TEST_CASE("idle workers sleep, and wake for the next job") {
    on_job_systems([](JobSystem& jobs) {
        for (int round = 0; round < 20; ++round) {
            while (jobs.statistics().threads_asleep != static_cast<std::uint64_t>(jobs.worker_count()))
                std::this_thread::yield();
            std::atomic<bool> ran{false};
            jobs.submit([&ran] { ran = true; });
            while (!ran) std::this_thread::yield();
        }
    });
}

TEST_CASE("threads may come and go, and use several systems") {
    JobSystem first({.workers = 1});
    JobSystem second({.workers = 2});
    std::atomic<int> runs{0};
    for (int round = 0; round < 50; ++round) {
        std::thread([&] {
            Counter counters[2];
            for (int job = 0; job < 20; ++job) {
                const bool even = job % 2 == 0;
                (even ? first : second).submit([&runs] { ++runs; }, &counters[even ? 0 : 1]);
            }
            JobSystem third({.workers = 1});
            third.submit([&runs] { ++runs; });
            first.wait(counters[0]);
            second.wait(counters[1]);
        }).join();
    }
    CHECK(runs == 50 * 21);
}

}  // namespace
}  // namespace ridgeline::jobs
