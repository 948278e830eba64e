// A counter of unfinished jobs, to wait for or to continue from.
//
// Lives on the stack or in an object of whoever waits; must outlive its jobs, and may be destroyed as soon as
// wait() returned or done() held: the last thing a finishing job does with its counter is the store that
// makes it done. May be raised again at any time. Any thread may read done().
#pragma once

#include <atomic>
#include <cstdint>

#include "ridgeline/base/contract.h"

namespace ridgeline::jobs {

struct Continuation;

class Counter {
  public:
    Counter() = default;
    ~Counter() { RIDGELINE_ASSERT(done()); }
    Counter(const Counter&) = delete;
    Counter& operator=(const Counter&) = delete;

    // True when every job submitted with this counter has run; what they wrote is then visible.
    bool done() const { return word_.load(std::memory_order_acquire) == 0; }

  private:
    friend class JobSystem;

    // The word holds the unfinished jobs and two flags. Jobs that run out leave the flags behind, so the
    // counter is not done before the one who served them has cleared the word.
    static constexpr std::int64_t kSleepers = 1;
    static constexpr std::int64_t kContinuations = 2;
    static constexpr std::int64_t kJob = 4;

    std::atomic<std::int64_t> word_{0};
    // Guarded by the job system's mutex of the slow path.
    Continuation* continuations_ = nullptr;
};

}  // namespace ridgeline::jobs
