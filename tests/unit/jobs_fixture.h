// A job system under test, and captures that notice when they are lost.
#pragma once

#include <doctest/doctest.h>

#include <atomic>
#include <memory>
#include <utility>

#include "ridgeline/jobs/job_system.h"

namespace ridgeline::jobs::test {

// Fewer, as many and more than the cores of a small machine.
inline constexpr int kWorkerCounts[] = {1, 2, 3, 4};

// A move-only capture; the number of those that live must come back to zero.
class Tracked {
  public:
    Tracked() { live().fetch_add(1); }
    Tracked(Tracked&& other) noexcept : held_(std::exchange(other.held_, false)) {}
    Tracked& operator=(Tracked&&) = delete;
    ~Tracked() {
        if (held_) live().fetch_sub(1);
    }

    static std::atomic<int>& live() {
        static std::atomic<int> count{0};
        return count;
    }

  private:
    bool held_ = true;
};

// Runs `test(jobs)` on systems with several numbers of workers and fails on jobs, continuations, loops or
// captures that are left over.
template <class Test>
void on_job_systems(Test test) {
    for (const int workers : kWorkerCounts) {
        CAPTURE(workers);
        {
            JobSystem jobs({.workers = workers});
            test(jobs);
            // Every test waits for what it submits, but helpers of loops may still be on their way.
            while (jobs.statistics().submitted != jobs.statistics().finished) std::this_thread::yield();
            const auto end = jobs.statistics();
            CHECK(end.continuations_waiting == 0);
            CHECK(end.ranges_open == 0);
        }
        CHECK(Tracked::live() == 0);
    }
}

}  // namespace ridgeline::jobs::test
