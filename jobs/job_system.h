// The job system: runs short jobs on a fixed set of worker threads.
//
// Any thread may submit, wait and loop in parallel, jobs included; a thread that waits runs other jobs
// meanwhile. Jobs go through two shared queues, urgent before normal, and start in no guaranteed order. In
// steady state nothing allocates: jobs are stored inline, and what a thread needs is made at its first call
// and kept. Idle workers sleep.
//
// A job may wait for jobs that it submitted or that were submitted before it, but not for one that may be
// suspended beneath it (a job that itself waits). Jobs never block on I/O or GL.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include "ridgeline/base/contract.h"
#include "ridgeline/jobs/counter.h"
#include "ridgeline/jobs/job.h"
#include "ridgeline/jobs/parallel_range.h"

namespace ridgeline::jobs {

class JobCore;

struct JobSystemOptions {
    // Cores − 1, but at least one: the thread that waits works too.
    static int default_workers();

    // Worker threads, at least 1.
    int workers = default_workers();
    // Called on each worker with its index, before its first job and after its last; for clocks and traces.
    std::function<void(int worker)> on_worker_start{};
    std::function<void(int worker)> on_worker_stop{};
};

// Urgent jobs start before all normal ones: what a frame waits for.
enum class Priority { normal, urgent };

// What a waiting thread may run meanwhile. A render thread takes only urgent jobs, lest a long one hold its
// frame up.
enum class Help { any, urgent_only };

class JobSystem {
  public:
    // Returns when every worker has started.
    explicit JobSystem(const JobSystemOptions& options = {});
    // Runs everything submitted, continuations included, then joins the workers.
    ~JobSystem();
    JobSystem(const JobSystem&) = delete;
    JobSystem& operator=(const JobSystem&) = delete;

    int worker_count() const;

    // Runs `job` on some worker (or on a thread that waits), then lowers `counter`, if one is given.
    template <class F>
    void submit(F&& job, Counter* counter = nullptr, Priority priority = Priority::normal) {
        enqueue(Job(std::forward<F>(job)), counter, priority);
    }

    // Returns when every job submitted with `counter` is done; runs jobs meanwhile.
    void wait(Counter& counter, Help help = Help::any);

    // Submits `job` when `after` reaches zero, at once if it stands there. `counter` counts it from now on.
    template <class F>
    void then(Counter& after, F&& job, Counter* counter = nullptr, Priority priority = Priority::normal) {
        continue_after(after, Job(std::forward<F>(job)), counter, priority);
    }

    // Calls body(index) once for each index in [begin, end), on this thread and on workers that have time,
    // and returns when all calls have. Indices are handed out `grain` at a time.
    template <class F>
    void parallel_for(std::int64_t begin, std::int64_t end, std::int64_t grain, F&& body,
                      Priority priority = Priority::normal) {
        parallel_for_ranges(
            begin, end, grain,
            [&body](std::int64_t first, std::int64_t last) {
                for (std::int64_t index = first; index < last; ++index) body(index);
            },
            priority);
    }

    // The same with body(first, last) for each range of at most `grain` indices.
    template <class F>
    void parallel_for_ranges(std::int64_t begin, std::int64_t end, std::int64_t grain, F&& body,
                             Priority priority = Priority::normal) {
        using Body = std::remove_reference_t<F>;
        const auto participate = [](ParallelRange& range, int part, void* erased) {
            range.consume(part, *static_cast<Body*>(erased));
        };
        run_range({begin, end, grain}, participate,
                  const_cast<void*>(static_cast<const void*>(std::addressof(body))), priority);
    }

    // Counts since construction; exact while no job is submitted or running.
    struct Statistics {
        std::uint64_t submitted = 0;
        std::uint64_t finished = 0;
        // Continuations that wait for their counter.
        std::uint64_t continuations_waiting = 0;
        // Parallel loops that have not returned.
        std::uint64_t ranges_open = 0;
        // Workers and waiting threads that sleep now.
        std::uint64_t threads_asleep = 0;
    };
    Statistics statistics() const;

  private:
    void enqueue(Job&& job, Counter* counter, Priority priority);
    void continue_after(Counter& after, Job&& job, Counter* counter, Priority priority);
    void run_range(const ParallelRange::Shape& shape, ParallelRange::Participate participate, void* body,
                   Priority priority);

    std::shared_ptr<JobCore> core_;
    std::vector<std::thread> threads_;
};

}  // namespace ridgeline::jobs
