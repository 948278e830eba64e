// A bounded stack of jobs that a thread submits while it runs a job: the owner pushes and pops on top, other
// threads steal from the bottom.
//
// Newest first keeps the nesting of waits as deep as the recursion of the jobs, not as their number; oldest
// first hands thieves the largest piece. Any thread may call anything; the lock is held for one move of a
// job.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <utility>

#include "ridgeline/base/thread_annotations.h"
#include "ridgeline/jobs/job.h"

namespace ridgeline::jobs {

class JobStack {
  public:
    // Recursions push one job a level; what exceeds this goes to the shared queue.
    static constexpr std::size_t kCapacity = 128;

    bool empty() const { return size_.load(std::memory_order_acquire) == 0; }

    // False, and `job` untouched, when full.
    bool push(Job& job) {
        MutexLock lock(mutex_);
        const auto size = size_.load(std::memory_order_relaxed);
        if (size == kCapacity) return false;
        jobs_[(bottom_ + size) % kCapacity] = std::move(job);
        size_.store(size + 1, std::memory_order_release);
        return true;
    }

    bool pop(Job& job) {
        if (empty()) return false;
        MutexLock lock(mutex_);
        const auto size = size_.load(std::memory_order_relaxed);
        if (size == 0) return false;
        job = std::move(jobs_[(bottom_ + size - 1) % kCapacity]);
        size_.store(size - 1, std::memory_order_release);
        return true;
    }

    bool steal(Job& job) {
        if (empty()) return false;
        MutexLock lock(mutex_);
        const auto size = size_.load(std::memory_order_relaxed);
        if (size == 0) return false;
        job = std::move(jobs_[bottom_]);
        bottom_ = (bottom_ + 1) % kCapacity;
        size_.store(size - 1, std::memory_order_release);
        return true;
    }

  private:
    Mutex mutex_;
    std::array<Job, kCapacity> jobs_ RIDGELINE_GUARDED_BY(mutex_);
    std::size_t bottom_ RIDGELINE_GUARDED_BY(mutex_) = 0;
    // Written under the mutex, read anywhere.
    std::atomic<std::size_t> size_{0};
};

}  // namespace ridgeline::jobs
