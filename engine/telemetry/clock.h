// Clocks: the steady clock that everything recorded refers to, CPU time of threads and of the process, memory
// in use.
//
// Any thread. Nothing here allocates.
#pragma once

#include <pthread.h>

#include <chrono>
#include <cstdint>

namespace ridgeline::telemetry {

// Nanoseconds of a steady clock; only differences mean anything.
std::int64_t now_ns();

inline double milliseconds(std::int64_t duration_ns) { return static_cast<double>(duration_ns) * 1e-6; }

// The CPU time of one thread, readable from any other while the thread lives.
class ThreadCpuClock {
  public:
    static ThreadCpuClock of_this_thread();

    // CPU time since the thread began, or zero once it has ended.
    std::int64_t used_ns() const;

  private:
    clockid_t clock_ = 0;
};

// How often this thread has waited for something since it began: gave its core away by itself. That another
// thread took its core does not count, so it tells waiting from being slow on a busy machine.
std::int64_t waits_of_this_thread();

// CPU time of all threads since the process began.
std::int64_t process_cpu_ns();

// The most memory that was resident at any time; what is resident now. Zero where /proc cannot be read.
std::uint64_t peak_rss_bytes();
std::uint64_t current_rss_bytes();
// Files and sockets that the process has open. Zero where /proc cannot be read.
std::int64_t open_handles();

}  // namespace ridgeline::telemetry
