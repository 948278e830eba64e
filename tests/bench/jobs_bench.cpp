// The job system beside oneTBB, in one run, on the same cores, with the same number of threads.
//
//   bench_jobs [WORKERS]      default 1; the thread that submits works too, so two threads in all
//
// Each case runs nine times with either library, by turns, after one run of each that does not count; the
// medians and their ratio are printed. Both libraries make one body call an item. The last line is what an
// idle pool costs.
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>
#include <time.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <thread>
#include <vector>

#include "ridgeline/jobs/job_system.h"

namespace {

using ridgeline::jobs::Counter;
using ridgeline::jobs::JobSystem;

constexpr int kItems = 1'000'000;
constexpr int kRuns = 9;

struct Case {
    const char* name;
    std::int64_t items;
    std::function<void()> ours;
    std::function<void()> tbb;
};

double seconds_of(const std::function<void()>& run) {
    const auto start = std::chrono::steady_clock::now();
    run();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> values) {
    std::ranges::nth_element(values, values.begin() + kRuns / 2);
    return values[kRuns / 2];
}

void compare(const Case& variant) {
    std::vector<double> ours;
    std::vector<double> tbb;
    seconds_of(variant.ours);
    seconds_of(variant.tbb);
    for (int run = 0; run < kRuns; ++run) {
        ours.push_back(seconds_of(variant.ours));
        tbb.push_back(seconds_of(variant.tbb));
    }
    const double items_m = static_cast<double>(variant.items) * 1e-6;
    std::printf("%-34s %8.2f M/s %8.2f M/s   %.2f\n", variant.name, items_m / median(ours),
                items_m / median(tbb), median(tbb) / median(ours));
}

double cpu_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

double idle_cpu_percent() {
    // Past the last look for work.
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    const double start = cpu_seconds();
    std::this_thread::sleep_for(std::chrono::seconds(1));
    return 100.0 * (cpu_seconds() - start);
}

// What an item of parallel_for does: as little as keeps the compiler from seeing that it does nothing.
struct Touch {
    std::vector<std::uint8_t>& touched;
    void operator()(std::int64_t item) const { touched[static_cast<std::size_t>(item)] = 1; }
};

std::int64_t fork_join(JobSystem& jobs, int depth) {
    if (depth == 0) return 1;
    std::int64_t left = 0;
    Counter counter;
    jobs.submit([&jobs, &left, depth] { left = fork_join(jobs, depth - 1); }, &counter);
    const std::int64_t right = fork_join(jobs, depth - 1);
    jobs.wait(counter);
    return left + right;
}

std::int64_t fork_join_tbb(int depth) {
    if (depth == 0) return 1;
    std::int64_t left = 0;
    std::int64_t right = 0;
    tbb::parallel_invoke([&] { left = fork_join_tbb(depth - 1); }, [&] { right = fork_join_tbb(depth - 1); });
    return left + right;
}

void compare_one_wait(JobSystem& jobs, tbb::task_arena& arena) {
    compare({"10^6 empty jobs, one wait", kItems,
             [&] {
                 Counter counter;
                 for (int job = 0; job < kItems; ++job) jobs.submit([] {}, &counter);
                 jobs.wait(counter);
             },
             [&] {
                 arena.execute([] {
                     tbb::task_group group;
                     for (int job = 0; job < kItems; ++job) group.run([] {});
                     group.wait();
                 });
             }});
}

void compare_many_waits(JobSystem& jobs, tbb::task_arena& arena) {
    constexpr int kBatch = 1000;
    compare({"the same, a wait every 1000", kItems,
             [&] {
                 for (int batch = 0; batch < kItems / kBatch; ++batch) {
                     Counter counter;
                     for (int job = 0; job < kBatch; ++job) jobs.submit([] {}, &counter);
                     jobs.wait(counter);
                 }
             },
             [&] {
                 arena.execute([] {
                     for (int batch = 0; batch < kItems / kBatch; ++batch) {
                         tbb::task_group group;
                         for (int job = 0; job < kBatch; ++job) group.run([] {});
                         group.wait();
                     }
                 });
             }});
}

void compare_parallel_for(JobSystem& jobs, tbb::task_arena& arena) {
    std::vector<std::uint8_t> touched(kItems);
    compare({"parallel_for, 10^6 items, grain 1", kItems,
             [&] { jobs.parallel_for(0, kItems, 1, Touch{touched}); },
             [&] {
                 arena.execute([&] {
                     const tbb::blocked_range<std::int64_t> items(0, kItems, 1);
                     tbb::parallel_for(
                         items,
                         [touch = Touch{touched}](const tbb::blocked_range<std::int64_t>& range) {
                             for (auto item = range.begin(); item < range.end(); ++item) touch(item);
                         },
                         tbb::simple_partitioner());
                 });
             }});
}

void compare_fork_join(JobSystem& jobs, tbb::task_arena& arena) {
    constexpr int kDepth = 16;
    compare({"fork-join of two, depth 16", 1 << kDepth, [&] { fork_join(jobs, kDepth); },
             [&] { arena.execute([] { fork_join_tbb(kDepth); }); }});
}

}  // namespace

int main(int argc, char** argv) {
    const int workers = argc > 1 ? std::atoi(argv[1]) : 1;
    JobSystem jobs({.workers = workers});
    tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                              static_cast<std::size_t>(workers) + 1);
    tbb::task_arena arena(workers + 1);

    std::printf("%d threads, median of %d              ours          oneTBB        ratio\n", workers + 1,
                kRuns);
    compare_one_wait(jobs, arena);
    compare_many_waits(jobs, arena);
    compare_parallel_for(jobs, arena);
    compare_fork_join(jobs, arena);
    std::printf("idle CPU of both pools: %.2f %%\n", idle_cpu_percent());
    return 0;
}
