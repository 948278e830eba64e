#include <doctest/doctest.h>

#include <atomic>
#include <memory>

#include "ridgeline/jobs/job_system.h"
#include "ridgeline/jobs/mailbox.h"
#include "ridgeline/jobs/queue.h"
#include "ridgeline/telemetry/allocation_counter.h"

namespace ridgeline::jobs {
namespace {

// What a frame may do with jobs, and more of it.
void use_jobs(JobSystem& jobs, Queue<int>& queue, Mailbox<int>& mailbox) {
    std::atomic<int> sum{0};
    Counter counter;
    Counter after;
    for (int job = 0; job < 500; ++job) jobs.submit([&sum] { ++sum; }, &counter);
    jobs.submit([&jobs, &counter] { jobs.submit([] {}, &counter); }, &counter, Priority::urgent);
    for (int next = 0; next < 5; ++next)
        jobs.then(
            counter, [&sum] { ++sum; }, &after);
    jobs.parallel_for(0, 1000, 1, [&sum](std::int64_t) { ++sum; });
    jobs.wait(counter);
    jobs.wait(after);
    for (int message = 0; message < 100; ++message) queue.sender().send(message);
    for (int message = 0; queue.receiver().receive(message);) mailbox.draft() = message;
    mailbox.publish();
}

TEST_CASE("after a first round, jobs, loops, continuations, queue and mailbox allocate nothing") {
    REQUIRE(telemetry::counts_heap_allocations());
    JobSystem jobs({.workers = 2});
    Queue<int> queue(256);
    Mailbox<int> mailbox;
    use_jobs(jobs, queue, mailbox);
    const auto before = telemetry::heap_allocations();
    for (int round = 0; round < 200; ++round) use_jobs(jobs, queue, mailbox);
    CHECK(telemetry::heap_allocations() - before == 0);
}

}  // namespace
}  // namespace ridgeline::jobs
