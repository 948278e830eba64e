// Two shared queues and careful sleep.
//
// Literature: the queue is Desrochers', "A fast general purpose lock-free queue for C++" (2014); helping
// while waiting is Blumofe and Leiserson's (JACM 46, 1999); the batch that shrinks with what is left is
// guided self-scheduling, Polychronopoulos and Kuck (IEEE Trans. Computers C-36, 1987).
//
// How we differ from work-stealing deques: jobs here are terrain tiles and silhouettes, made by few threads
// and rarely by each other, so one queue with a lane per producer loses nothing, keeps them roughly in order,
// and lets urgent jobs overtake. What deques are good at, loops split finely, is left to ParallelRange. A
// worker takes jobs in batches only while they are short and many, and gives the rest back before it waits,
// so that no job hides behind a waiter.
//
// Sleep: whoever is about to sleep enters the list, then looks at what it waits for once more; whoever brings
// a job or finishes a counter does so and then looks whether someone sleeps. Both looks are
// read-modify-writes of sleeping_ (the waker adds zero), so one of the two comes later and sees the other.
// try_dequeue may miss a job for a moment while another consumer backs out; size_approx, which counts what
// was really taken, decides about sleep.
#include "ridgeline/jobs/job_core.h"

#include <algorithm>
#include <iterator>
#include <thread>

namespace ridgeline::jobs {
namespace {

// Room for so many jobs under way before the queue grows.
constexpr std::size_t kPreallocatedJobs = 4096;
// Threads beside the workers, parallel loops of a priority at once, and continuations waiting at once, that
// there is room for from the start.
constexpr int kExpectedThreads = 16;
constexpr int kExpectedLoops = 16;
constexpr int kExpectedContinuations = 256;
// Looks for work before going to sleep, some tens of microseconds, about what a sleep and a wake cost: first
// with a pause between them, then yielding the core, which on a busy machine lets the thread that makes the
// work go on instead of having it wake this one for every job.
constexpr int kLooksWithPause = 100;
constexpr int kLooksBeforeSleep = 200;
// A batch should last shorter than anyone would mind waiting, and longer than taking it costs.
constexpr auto kLongBatch = std::chrono::microseconds(50);
constexpr auto kShortBatch = std::chrono::microseconds(20);
// The share of the waiting jobs that a thread takes is one in this, divided by the number of threads.
constexpr int kShareOfWaiting = 4;

std::atomic<std::uint64_t> next_core_id{1};

void pause_core() {
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#elif defined(__aarch64__)
    asm volatile("yield");
#endif
}

// After a look in vain; false when it is time to sleep.
bool may_look_again(int& looks) {
    if (++looks >= kLooksBeforeSleep) return false;
    if (looks < kLooksWithPause)
        pause_core();
    else
        std::this_thread::yield();
    return true;
}

// For counts that one thread writes.
void add_one(std::atomic<std::uint64_t>& count) {
    count.store(count.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
}

}  // namespace

// --- Seats ---

JobCore::Seat::Seat(JobCore& core)
    : normal_in(core.normal_), urgent_in(core.urgent_), normal_out(core.normal_), urgent_out(core.urgent_) {}

struct JobCore::SeatHolder {
    struct Held {
        std::uint64_t core_id;
        std::weak_ptr<JobCore> core;
        Seat* seat;
    };
    std::vector<Held> held;

    // The seat used last, looked up without the vector.
    static thread_local constinit std::uint64_t last_core_id;
    static thread_local constinit Seat* last_seat;
    static SeatHolder& of_this_thread() {
        static thread_local SeatHolder holder;
        return holder;
    }

    ~SeatHolder() {
        last_core_id = 0;
        for (Held& entry : held)
            if (const auto core = entry.core.lock()) core->give_seat_back(*entry.seat);
    }
};
thread_local constinit std::uint64_t JobCore::SeatHolder::last_core_id = 0;
thread_local constinit JobCore::Seat* JobCore::SeatHolder::last_seat = nullptr;

JobCore::Seat& JobCore::seat() {
    if (SeatHolder::last_core_id != id_) {
        SeatHolder::last_seat = &find_or_take_seat();
        SeatHolder::last_core_id = id_;
    }
    return *SeatHolder::last_seat;
}

JobCore::Seat& JobCore::find_or_take_seat() {
    auto& held = SeatHolder::of_this_thread().held;
    std::erase_if(held, [](const SeatHolder::Held& entry) { return entry.core.expired(); });
    const auto ours = std::ranges::find(held, id_, &SeatHolder::Held::core_id);
    if (ours != held.end()) return *ours->seat;
    held.push_back({id_, weak_from_this(), &take_seat()});
    return *held.back().seat;
}

JobCore::Seat& JobCore::take_seat() {
    MutexLock lock(mutex_);
    if (!free_seats_.empty()) {
        Seat& free = *free_seats_.back();
        free_seats_.pop_back();
        return free;
    }
    Seat& made = seats_.emplace_back(*this);
    made.next = first_seat_.load(std::memory_order_relaxed);
    first_seat_.store(&made, std::memory_order_release);
    return made;
}

void JobCore::give_seat_back(Seat& seat) {
    MutexLock lock(mutex_);
    free_seats_.push_back(&seat);
}

// --- Life ---

JobCore::JobCore(int workers)
    : workers_(workers),
      id_(next_core_id.fetch_add(1)),
      normal_(kPreallocatedJobs),
      urgent_(kPreallocatedJobs),
      workers_to_start_(workers) {
    MutexLock lock(mutex_);
    sleepers_.reserve(static_cast<std::size_t>(workers + kExpectedThreads));
    for (auto& free : free_ranges_)
        for (int loop = 0; loop < kExpectedLoops; ++loop) free.push_back(&ranges_.emplace_back(workers + 1));
    for (int i = 0; i < kExpectedContinuations; ++i) {
        Continuation& made = continuations_.emplace_back();
        made.next = std::exchange(free_continuation_, &made);
    }
}

void JobCore::work() {
    Seat& own = seat();
    workers_to_start_.count_down();
    const auto stopping = [this] { return stopping_.load(std::memory_order_acquire); };
    for (int looks = 0;;) {
        if (run_some(own, Help::any)) {
            looks = 0;
        } else if (stopping()) {
            if (!job_waits(Takes::anything)) return;
        } else if (!may_look_again(looks)) {
            sleep_unless(stopping, own, nullptr, Takes::anything);
            looks = 0;
        }
    }
}

void JobCore::stop() {
    stopping_.store(true, std::memory_order_release);
    wake_waiters_of(nullptr);
}

JobSystem::Statistics JobCore::statistics() const {
    MutexLock lock(mutex_);
    JobSystem::Statistics sum;
    for (const Seat& seat : seats_) {
        sum.submitted += seat.submitted.load(std::memory_order_relaxed);
        sum.finished += seat.finished.load(std::memory_order_relaxed);
    }
    sum.threads_asleep = sleepers_.size();
    sum.continuations_waiting = continuations_waiting_;
    sum.ranges_open = ranges_.size() - free_ranges_[0].size() - free_ranges_[1].size();
    return sum;
}

// --- Submitting and running ---

void JobCore::enqueue(Job&& job, Counter* counter, Priority priority) {
    job.counter = counter;
    if (counter) counter->word_.fetch_add(Counter::kJob, std::memory_order_relaxed);
    put_in_queue(seat(), std::move(job), priority);
}

void JobCore::put_in_queue(Seat& seat, Job&& job, Priority priority) {
    add_one(seat.submitted);
    if (priority == Priority::urgent) urgent_waiting_.fetch_add(1, std::memory_order_relaxed);
    if (seat.depth == 0 || !stack_of(seat, priority).push(job)) {
        const bool queued = priority == Priority::urgent ? urgent_.enqueue(seat.urgent_in, std::move(job))
                                                         : normal_.enqueue(seat.normal_in, std::move(job));
        // Only want of memory refuses a job.
        RIDGELINE_CHECK(queued);
    }
    wake_for_job(priority);
}

JobStack& JobCore::stack_of(Seat& seat, Priority priority) {
    return seat.stacks[static_cast<std::size_t>(priority)];
}

// What was begun comes before what was not: a thread's own stack, for a waiting job also those of others, the
// queue.
bool JobCore::run_some(Seat& seat, Help help) {
    if (run_urgent(seat)) return true;
    if (help == Help::urgent_only) return false;
    // The batch in hand is that of the outermost job; inside it jobs are taken one at a time.
    return seat.depth > 0 ? run_nested(seat) : run_batch(seat);
}

bool JobCore::run_urgent(Seat& seat) {
    if (urgent_waiting_.load(std::memory_order_relaxed) == 0) return false;
    Job job;
    if (!take_urgent(seat, job)) return false;
    urgent_waiting_.fetch_sub(1, std::memory_order_relaxed);
    run_and_take_off(seat, job);
    return true;
}

bool JobCore::take_urgent(Seat& seat, Job& job) {
    return stack_of(seat, Priority::urgent).pop(job) || urgent_.try_dequeue(seat.urgent_out, job) ||
           steal(seat, Priority::urgent, job);
}

bool JobCore::run_nested(Seat& seat) {
    Job job;
    if (!stack_of(seat, Priority::normal).pop(job) && !steal(seat, Priority::normal, job) &&
        !normal_.try_dequeue(seat.normal_out, job))
        return false;
    run_and_take_off(seat, job);
    return true;
}

bool JobCore::run_stolen(Seat& seat) {
    Job job;
    if (!stack_of(seat, Priority::normal).pop(job) && !steal(seat, Priority::normal, job)) return false;
    run_and_take_off(seat, job);
    return true;
}

bool JobCore::steal(const Seat& thief, Priority priority, Job& job) {
    for (Seat* victim = first_seat_.load(std::memory_order_acquire); victim; victim = victim->next)
        if (victim != &thief && stack_of(*victim, priority).steal(job)) return true;
    return false;
}

void JobCore::run_and_take_off(Seat& seat, Job& job) {
    run_job(seat, job);
    take_off(job.counter, 1);
}

void JobCore::run_job(Seat& seat, Job& job) {
    ++seat.depth;
    job.run();
    --seat.depth;
    add_one(seat.finished);
}

bool JobCore::run_batch(Seat& seat) {
    if (!stack_of(seat, Priority::normal).empty()) return run_stolen(seat);
    const int taken = fetch_batch(seat);
    if (taken == 0) return run_stolen(seat);
    // A single job needs no timing unless it could be the first of larger batches.
    if (taken == 1 && seat.batch_limit > 1) {
        run_fetched(seat);
        return true;
    }
    const auto start = std::chrono::steady_clock::now();
    run_fetched(seat);
    adapt_batch_limit(seat, taken, std::chrono::steady_clock::now() - start);
    return true;
}

int JobCore::fetch_batch(Seat& seat) {
    std::size_t size = 1;
    if (seat.batch_limit > 1) {
        const std::size_t share =
            normal_.size_approx() / static_cast<std::size_t>(kShareOfWaiting * (workers_ + 1));
        size = std::clamp<std::size_t>(share, 1, static_cast<std::size_t>(seat.batch_limit));
    }
    seat.next_in_batch = 0;
    seat.batch_size = static_cast<int>(normal_.try_dequeue_bulk(seat.normal_out, seat.batch.begin(), size));
    return seat.batch_size;
}

// Jobs of one counter that follow each other are taken off it together: who waits for the counter waits for
// the later ones too.
void JobCore::run_fetched(Seat& seat) {
    Counter* counter = nullptr;
    int finished = 0;
    const auto settle = [&] { take_off(counter, std::exchange(finished, 0)); };
    while (seat.next_in_batch < seat.batch_size) {
        Job& job = seat.batch[static_cast<std::size_t>(seat.next_in_batch++)];
        if (job.counter != counter) {
            settle();
            counter = job.counter;
        }
        run_job(seat, job);
        ++finished;
        if (urgent_waiting_.load(std::memory_order_relaxed) > 0) {
            settle();
            run_urgent(seat);
        }
    }
    settle();
}

void JobCore::adapt_batch_limit(Seat& seat, int taken, std::chrono::steady_clock::duration spent) {
    const bool given_back = seat.batch_size < taken;
    if (given_back || spent > kLongBatch)
        seat.batch_limit = 1;
    else if (spent < kShortBatch)
        seat.batch_limit = std::min(kMaxBatch, seat.batch_limit * 2);
}

void JobCore::give_batch_back(Seat& seat) {
    const int rest = seat.batch_size - seat.next_in_batch;
    if (rest == 0) return;
    const auto first = std::make_move_iterator(seat.batch.begin() + seat.next_in_batch);
    const bool queued = normal_.enqueue_bulk(seat.normal_in, first, static_cast<std::size_t>(rest));
    RIDGELINE_CHECK(queued);
    seat.batch_size = seat.next_in_batch;
    for (int job = 0; job < rest; ++job) wake_for_job(Priority::normal);
}

// --- Counters ---

void JobCore::take_off(Counter* counter, int jobs) {
    if (!counter || jobs == 0) return;
    auto word = counter->word_.load(std::memory_order_relaxed);
    std::int64_t rest = 0;
    do {
        rest = word - jobs * Counter::kJob;
        if (rest == Counter::kContinuations) rest |= Counter::kStarting;
    } while (!counter->word_.compare_exchange_weak(word, rest, std::memory_order_acq_rel,
                                                   std::memory_order_relaxed));
    if (rest == 0)
        wake_waiters_of(counter);
    else if (rest == (Counter::kContinuations | Counter::kStarting) && (word & Counter::kStarting) == 0)
        start_continuations(*counter);
}

void JobCore::start_continuations(Counter& counter) {
    Continuation* const first = take_continuations(counter);
    if (!first) return;
    wake_waiters_of(&counter);
    submit_continuations(first);
}

// Null if the counter was raised again in the meantime: its continuations then wait for its next end.
// Otherwise the counter is done when this returns, and may be gone.
Continuation* JobCore::take_continuations(Counter& counter) {
    MutexLock lock(mutex_);
    Continuation* const first = counter.continuations_;
    auto word = counter.word_.load(std::memory_order_relaxed);
    bool raised_again = false;
    do {
        raised_again = word >= Counter::kJob;
        counter.continuations_ = raised_again ? first : nullptr;
    } while (!counter.word_.compare_exchange_weak(word, raised_again ? word & ~Counter::kStarting : 0,
                                                  std::memory_order_acq_rel));
    return raised_again ? nullptr : first;
}

void JobCore::submit_continuations(Continuation* first) {
    while (first) {
        Job job = std::move(first->job);
        const Priority priority = first->priority;
        Continuation* const next = first->next;
        recycle(*first);
        put_in_queue(seat(), std::move(job), priority);
        first = next;
    }
}

void JobCore::recycle(Continuation& continuation) {
    MutexLock lock(mutex_);
    continuation.next = std::exchange(free_continuation_, &continuation);
    --continuations_waiting_;
}

void JobCore::continue_after(Counter& after, Job&& job, Counter* counter, Priority priority) {
    RIDGELINE_CHECK(counter != &after);
    job.counter = counter;
    if (counter) counter->word_.fetch_add(Counter::kJob, std::memory_order_relaxed);
    if (!keep_for(after, job, priority)) put_in_queue(seat(), std::move(job), priority);
}

bool JobCore::keep_for(Counter& after, Job& job, Priority priority) {
    MutexLock lock(mutex_);
    auto word = after.word_.load(std::memory_order_acquire);
    do {
        if (word == 0) return false;
    } while (!after.word_.compare_exchange_weak(word, word | Counter::kContinuations,
                                                std::memory_order_acq_rel, std::memory_order_acquire));
    if (!free_continuation_) free_continuation_ = &continuations_.emplace_back();
    Continuation& kept = *free_continuation_;
    free_continuation_ = kept.next;
    kept.job = std::move(job);
    kept.priority = priority;
    kept.next = std::exchange(after.continuations_, &kept);
    ++continuations_waiting_;
    return true;
}

void JobCore::wait(Counter& counter, Help help) {
    if (counter.done()) return;
    Seat& own = seat();
    give_batch_back(own);
    // A job that waits must take whatever there is: nobody else may be left to run what it waits for.
    if (own.depth > 0) help = Help::any;
    const Takes takes = help == Help::any ? Takes::anything : Takes::urgent;
    const auto done = [&counter] { return counter.done(); };
    bool slept = false;
    for (int looks = 0; !done();) {
        if (run_some(own, help)) {
            looks = 0;
        } else if (!may_look_again(looks)) {
            sleep_unless(done, own, &counter, takes);
            slept = true;
            looks = 0;
        }
    }
    if (slept) pass_wake_on();
}

// --- Parallel loops ---

void JobCore::run_range(const ParallelRange::Shape& shape, ParallelRange::Participate participate, void* body,
                        Priority priority) {
    RIDGELINE_CHECK(shape.grain > 0);
    if (shape.begin >= shape.end) return;
    give_batch_back(seat());
    ParallelRange& range = acquire_range(priority);
    const std::int64_t items_at_once =
        std::min(shape.end - shape.begin, ParallelRange::kMaxUnits) * shape.grain;
    for (ParallelRange::Shape block = shape; block.begin < shape.end; block.begin = block.end) {
        block.end = shape.end - block.begin > items_at_once ? block.begin + items_at_once : shape.end;
        run_block(range, block, participate, body, priority);
    }
    release_range(range, priority);
}

void JobCore::run_block(ParallelRange& range, const ParallelRange::Shape& block,
                        ParallelRange::Participate participate, void* body, Priority priority) {
    const auto parts = static_cast<int>(std::min<std::int64_t>(workers_ + 1, block.units()));
    for (int called = range.open(block, parts, participate, body); called > 0; --called)
        enqueue(Job([this, &range] { help(range); }), nullptr, priority);
    range.work_as_caller();
    if (!range.close()) wait_for_helpers(range);
}

void JobCore::help(ParallelRange& range) {
    if (range.arrive_as_helper()) wake_waiters_of(&range);
}

// Only the grains in hand are left, so nothing else is begun meanwhile.
void JobCore::wait_for_helpers(const ParallelRange& range) {
    const auto settled = [&range] { return range.settled(); };
    for (int looks = 0; !settled() && may_look_again(looks);) {
    }
    while (!settled()) sleep_unless(settled, seat(), &range, Takes::nothing);
}

ParallelRange& JobCore::acquire_range(Priority priority) {
    MutexLock lock(mutex_);
    auto& free = free_ranges_[static_cast<std::size_t>(priority)];
    if (free.empty()) return ranges_.emplace_back(workers_ + 1);
    ParallelRange& range = *free.back();
    free.pop_back();
    return range;
}

void JobCore::release_range(ParallelRange& range, Priority priority) {
    MutexLock lock(mutex_);
    free_ranges_[static_cast<std::size_t>(priority)].push_back(&range);
}

// --- Sleep ---

namespace {

// sleeping_ holds four counts of sixteen bits: sleepers that take anything, only urgent jobs, no job; and,
// beside these, those that wait for a counter or a range.
constexpr std::uint64_t kTakesAnything = 1;
constexpr std::uint64_t kTakesUrgent = std::uint64_t{1} << 16;
constexpr std::uint64_t kTakesNothing = std::uint64_t{1} << 32;
constexpr std::uint64_t kAwaits = std::uint64_t{1} << 48;

constexpr bool any_takes(std::uint64_t sleeping, Priority priority) {
    const std::uint64_t anything = kTakesUrgent - kTakesAnything;
    const std::uint64_t urgent = kTakesNothing - kTakesUrgent;
    return (sleeping & (priority == Priority::urgent ? anything | urgent : anything)) != 0;
}

}  // namespace

std::uint64_t JobCore::weight(const Seat& seat) {
    const std::uint64_t awaits = seat.awaited ? kAwaits : 0;
    switch (seat.takes) {
        case Takes::anything:
            return awaits + kTakesAnything;
        case Takes::urgent:
            return awaits + kTakesUrgent;
        case Takes::nothing:
            break;
    }
    return awaits + kTakesNothing;
}

template <class Ready>
void JobCore::sleep_unless(Ready ready, Seat& seat, const void* awaited, Takes takes) {
    lie_down(seat, awaited, takes);
    if ((ready() || job_waits(takes)) && get_up(seat)) return;
    // Either there is nothing to do, or someone has taken this seat off the list already and sounds its
    // alarm.
    seat.alarm.wait();
}

void JobCore::lie_down(Seat& seat, const void* awaited, Takes takes) {
    MutexLock lock(mutex_);
    seat.awaited = awaited;
    seat.takes = takes;
    sleepers_.push_back(&seat);
    sleeping_.fetch_add(weight(seat), std::memory_order_acq_rel);
}

bool JobCore::get_up(Seat& seat) {
    MutexLock lock(mutex_);
    const auto place = std::ranges::find(sleepers_, &seat);
    if (place == sleepers_.end()) return false;
    remove_sleeper(place);
    return true;
}

JobCore::Seat& JobCore::remove_sleeper(std::vector<Seat*>::iterator place) {
    Seat& seat = **place;
    sleepers_.erase(place);
    sleeping_.fetch_sub(weight(seat), std::memory_order_acq_rel);
    return seat;
}

bool JobCore::job_waits(Takes takes) const {
    if (takes == Takes::nothing) return false;
    if (urgent_.size_approx() > 0 || stacked_job_waits(Priority::urgent)) return true;
    if (takes == Takes::urgent) return false;
    return normal_.size_approx() > 0 || stacked_job_waits(Priority::normal);
}

bool JobCore::stacked_job_waits(Priority priority) const {
    for (Seat* seat = first_seat_.load(std::memory_order_acquire); seat; seat = seat->next)
        if (!stack_of(*seat, priority).empty()) return true;
    return false;
}

void JobCore::wake_for_job(Priority priority) {
    if (!any_takes(sleeping_.fetch_add(0, std::memory_order_acq_rel), priority)) return;
    MutexLock lock(mutex_);
    const auto would_take = [priority](const Seat* seat) { return any_takes(weight(*seat), priority); };
    const auto is_idle = [](const Seat* seat) { return !seat->awaited; };
    // Idle workers before waiters, which may have to leave before the job is done.
    auto place = std::ranges::find_if(sleepers_, is_idle);
    if (place == sleepers_.end()) place = std::ranges::find_if(sleepers_, would_take);
    if (place != sleepers_.end()) remove_sleeper(place).alarm.signal();
}

// A thread that was woken for a job but leaves because what it waited for is done lets another have the job.
void JobCore::pass_wake_on() {
    if (job_waits(Takes::urgent)) wake_for_job(Priority::urgent);
    if (job_waits(Takes::anything)) wake_for_job(Priority::normal);
}

void JobCore::wake_waiters_of(const void* awaited) {
    const auto sleeping = sleeping_.fetch_add(0, std::memory_order_acq_rel);
    if (awaited ? sleeping < kAwaits : sleeping == 0) return;
    MutexLock lock(mutex_);
    for (auto place = sleepers_.begin(); place != sleepers_.end();) {
        if ((*place)->awaited == awaited)
            remove_sleeper(place).alarm.signal();
        else
            ++place;
    }
}

}  // namespace ridgeline::jobs
