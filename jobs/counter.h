// A counter of unfinished jobs, to wait for or to continue from.
//
// Counts the jobs of one job system at a time. Lives on the stack or in an object of whoever waits; must
// outlive its jobs, and may be destroyed as soon as wait() returned or done() held: the last thing a
// finishing job does with its counter is the store that makes it done. May be raised again at any time. Any
// thread may read done().
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
    friend class JobCore;

    // The word holds the unfinished jobs and two flags: there are continuations; someone is starting them.
    // The counter is not done before that one has cleared the word, which is the last time it is touched.
    static constexpr std::int64_t kContinuations = 1;
    static constexpr std::int64_t kStarting = 2;
    static constexpr std::int64_t kJob = 4;

    std::atomic<std::int64_t> word_{0};
    // Guarded by the mutex of the job system.
    Continuation* continuations_ = nullptr;
};

}  // namespace ridgeline::jobs
