#include <doctest/doctest.h>

#include <atomic>
#include <memory>
#include <thread>
#include <vector>

#include "jobs_fixture.h"

namespace ridgeline::jobs {
namespace {

using test::on_job_systems;
using test::Tracked;

TEST_CASE("continuations run once, after every job of their counter") {
    on_job_systems([](JobSystem& jobs) {
        for (int round = 0; round < 300; ++round) {
            std::atomic<int> runs{0};
            std::atomic<int> early{0};
            std::atomic<int> continued{0};
            Counter first;
            Counter second;
            for (int job = 0; job < 10; ++job) jobs.submit([&runs] { ++runs; }, &first);
            for (int next = 0; next < 3; ++next) {
                jobs.then(
                    first,
                    [&, tracked = Tracked()] {
                        early += runs == 10 ? 0 : 1;
                        ++continued;
                    },
                    &second, next == 0 ? Priority::urgent : Priority::normal);
            }
            jobs.wait(second);
            REQUIRE(first.done());
            REQUIRE(continued == 3);
            REQUIRE(early == 0);
        }
    });
}

TEST_CASE("a continuation of a counter that is done runs at once") {
    on_job_systems([](JobSystem& jobs) {
        Counter done;
        Counter after;
        bool ran = false;
        jobs.then(
            done, [&ran] { ran = true; }, &after);
        jobs.wait(after);
        CHECK(ran);
    });
}

TEST_CASE("a chain of continuations runs in its order") {
    static constexpr std::size_t kLinks = 200;
    on_job_systems([](JobSystem& jobs) {
        std::vector<Counter> links(kLinks + 1);
        std::vector<std::size_t> order;
        // Held until the chain stands, so that every link has something to wait for.
        std::atomic<bool> gate{false};
        jobs.submit(
            [&gate] {
                while (!gate) std::this_thread::yield();
            },
            &links[0]);
        for (std::size_t link = 0; link < kLinks; ++link)
            jobs.then(
                links[link], [&order, link] { order.push_back(link); }, &links[link + 1]);
        gate = true;
        jobs.wait(links[kLinks]);
        REQUIRE(order.size() == kLinks);
        for (std::size_t link = 0; link < kLinks; ++link) REQUIRE(order[link] == link);
    });
}

TEST_CASE("a counter with continuations may be destroyed as soon as it is done") {
    on_job_systems([](JobSystem& jobs) {
        std::atomic<int> continued{0};
        Counter all;
        for (int round = 0; round < 2000; ++round) {
            Counter counter;
            jobs.submit([] {}, &counter);
            jobs.then(
                counter, [&continued] { ++continued; }, &all);
            jobs.wait(counter);
        }
        jobs.wait(all);
        CHECK(continued == 2000);
    });
}

TEST_CASE("a counter may be raised while its continuations start; they never run before a job they follow") {
    on_job_systems([](JobSystem& jobs) {
        std::atomic<int> early{0};
        std::atomic<int> continued{0};
        Counter shared;
        Counter all;
        std::vector<std::thread> threads;
        for (int thread = 0; thread < 2; ++thread) {
            threads.emplace_back([&] {
                for (int round = 0; round < 1000; ++round) {
                    auto ran = std::make_shared<std::atomic<bool>>(false);
                    jobs.submit([ran] { *ran = true; }, &shared);
                    jobs.then(
                        shared,
                        [ran, &early, &continued] {
                            early += *ran ? 0 : 1;
                            ++continued;
                        },
                        &all);
                }
            });
        }
        for (auto& thread : threads) thread.join();
        jobs.wait(shared);
        jobs.wait(all);
        CHECK(early == 0);
        CHECK(continued == 2000);
    });
}

}  // namespace
}  // namespace ridgeline::jobs
