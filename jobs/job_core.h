// The inside of the job system: queues, the place of each thread, sleep.
//
// Owned by the JobSystem; kept alive a moment longer by a thread that gives its seat back just then. See
// job_core.cpp for how sleeping and waking are made safe.
#pragma once

#include <concurrentqueue/concurrentqueue.h>
#include <concurrentqueue/lightweightsemaphore.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <latch>
#include <memory>
#include <vector>

#include "ridgeline/base/thread_annotations.h"
#include "ridgeline/jobs/job_stack.h"
#include "ridgeline/jobs/job_system.h"
#include "ridgeline/jobs/queue_traits.h"

namespace ridgeline::jobs {

// A job that waits for a counter to run out.
struct Continuation {
    Job job;
    Priority priority = Priority::normal;
    Continuation* next = nullptr;
};

class JobCore : public std::enable_shared_from_this<JobCore> {
  public:
    explicit JobCore(int workers);

    int worker_count() const { return workers_; }
    // The body of a worker thread: runs jobs until stop() was called and none is left.
    void work();
    // Returns when every worker has begun to work.
    void wait_for_workers() { workers_to_start_.wait(); }
    void stop();

    void enqueue(Job&& job, Counter* counter, Priority priority);
    void wait(Counter& counter, Help help);
    void continue_after(Counter& after, Job&& job, Counter* counter, Priority priority);
    void run_range(const ParallelRange::Shape& shape, ParallelRange::Participate participate, void* body,
                   Priority priority);
    JobSystem::Statistics statistics() const;

  private:
    using JobQueue = moodycamel::ConcurrentQueue<Job, QueueTraits>;

    // Jobs that a thread takes at once from the normal queue.
    static constexpr int kMaxBatch = 32;

    // What a sleeping thread may be woken to run.
    enum class Takes { anything, urgent, nothing };

    // A thread's place in the system: made at its first call, given back when it ends, used by no other
    // meanwhile.
    struct Seat {
        explicit Seat(JobCore& core);

        moodycamel::ProducerToken normal_in;
        moodycamel::ProducerToken urgent_in;
        moodycamel::ConsumerToken normal_out;
        moodycamel::ConsumerToken urgent_out;

        // Jobs submitted by the jobs of this thread, by priority.
        std::array<JobStack, 2> stacks;

        // The batch in hand: jobs before next_in_batch run or have run.
        std::array<Job, kMaxBatch> batch;
        int next_in_batch = 0;
        int batch_size = 0;
        int batch_limit = 1;
        // Jobs running on this thread, each inside a wait of the one before.
        int depth = 0;

        // Written by the thread of the seat alone.
        std::atomic<std::uint64_t> submitted{0};
        std::atomic<std::uint64_t> finished{0};

        // All seats ever made, for thieves.
        Seat* next = nullptr;

        // In the list of sleepers; guarded by mutex_.
        const void* awaited = nullptr;
        Takes takes = Takes::anything;
        moodycamel::LightweightSemaphore alarm{0, 0};
    };
    // Gives a thread's seats back when it ends.
    struct SeatHolder;
    friend struct SeatHolder;

    Seat& seat();
    Seat& find_or_take_seat();
    Seat& take_seat();
    void give_seat_back(Seat& seat);

    bool run_some(Seat& seat, Help help);
    bool run_urgent(Seat& seat);
    bool take_urgent(Seat& seat, Job& job);
    bool run_nested(Seat& seat);
    bool run_stolen(Seat& seat);
    bool steal(const Seat& thief, Priority priority, Job& job);
    bool run_batch(Seat& seat);
    int fetch_batch(Seat& seat);
    void run_fetched(Seat& seat);
    static void adapt_batch_limit(Seat& seat, int taken, std::chrono::steady_clock::duration spent);
    void run_job(Seat& seat, Job& job);
    void run_and_take_off(Seat& seat, Job& job);
    void give_batch_back(Seat& seat);
    void take_off(Counter* counter, int jobs);
    void start_continuations(Counter& counter);
    Continuation* take_continuations(Counter& counter);
    void submit_continuations(Continuation* first);
    void recycle(Continuation& continuation);
    bool keep_for(Counter& after, Job& job, Priority priority);
    void put_in_queue(Seat& seat, Job&& job, Priority priority);
    static JobStack& stack_of(Seat& seat, Priority priority);
    bool stacked_job_waits(Priority priority) const;

    ParallelRange& acquire_range(Priority priority);
    void release_range(ParallelRange& range, Priority priority);
    void run_block(ParallelRange& range, const ParallelRange::Shape& block,
                   ParallelRange::Participate participate, void* body, Priority priority);
    void wait_for_helpers(const ParallelRange& range);
    void help(ParallelRange& range);

    template <class Ready>
    void sleep_unless(Ready ready, Seat& seat, const void* awaited, Takes takes);
    void lie_down(Seat& seat, const void* awaited, Takes takes);
    bool get_up(Seat& seat);
    void wake_for_job(Priority priority);
    void wake_waiters_of(const void* awaited);
    void pass_wake_on();
    Seat& remove_sleeper(std::vector<Seat*>::iterator place) RIDGELINE_REQUIRES(mutex_);
    bool job_waits(Takes takes) const;
    static std::uint64_t weight(const Seat& seat);

    const int workers_;
    const std::uint64_t id_;
    JobQueue normal_;
    JobQueue urgent_;
    // Urgent jobs not taken yet; looked at between any two jobs.
    alignas(64) std::atomic<std::int64_t> urgent_waiting_{0};
    // How many sleep, by what they take: see weight().
    alignas(64) std::atomic<std::uint64_t> sleeping_{0};
    std::latch workers_to_start_;
    std::atomic<bool> stopping_{false};
    std::atomic<Seat*> first_seat_{nullptr};

    mutable Mutex mutex_;
    std::vector<Seat*> sleepers_ RIDGELINE_GUARDED_BY(mutex_);
    std::deque<Seat> seats_ RIDGELINE_GUARDED_BY(mutex_);
    std::vector<Seat*> free_seats_ RIDGELINE_GUARDED_BY(mutex_);
    std::deque<Continuation> continuations_ RIDGELINE_GUARDED_BY(mutex_);
    Continuation* free_continuation_ RIDGELINE_GUARDED_BY(mutex_) = nullptr;
    std::uint64_t continuations_waiting_ RIDGELINE_GUARDED_BY(mutex_) = 0;
    std::deque<ParallelRange> ranges_ RIDGELINE_GUARDED_BY(mutex_);
    std::array<std::vector<ParallelRange*>, 2> free_ranges_ RIDGELINE_GUARDED_BY(mutex_);
};

}  // namespace ridgeline::jobs
