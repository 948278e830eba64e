// The CPU time that is the program's own: of the render thread outside GL's functions, and of the workers,
// which select, order and decode. Drivers' threads, and what a software driver draws in its functions, are
// none of it.
//
// Render thread, with a GL context current; but for worker_started(), which each worker calls about itself.
#pragma once

#include <cstdint>
#include <vector>

#include "ridgeline/base/thread_annotations.h"
#include "ridgeline/gl/call_clock.h"
#include "ridgeline/telemetry/clock.h"

namespace ridgeline::app {

struct OwnCpuTime {
    double render_ms = 0.0, workers_ms = 0.0;

    double all_ms() const { return render_ms + workers_ms; }
    OwnCpuTime& operator+=(const OwnCpuTime& other) {
        render_ms += other.render_ms;
        workers_ms += other.workers_ms;
        return *this;
    }
};

class OwnCpu {
  public:
    void worker_started() RIDGELINE_EXCLUDES(mutex_);

    // Since the last call of it, or since it was made.
    OwnCpuTime take() RIDGELINE_EXCLUDES(mutex_);

  private:
    struct Sample {
        std::int64_t render_ns = 0, gl_ns = 0, workers_ns = 0;
    };
    Sample sample() RIDGELINE_EXCLUDES(mutex_);

    gl::CallClock calls_;
    telemetry::ThreadCpuClock render_ = telemetry::ThreadCpuClock::of_this_thread();
    Sample last_;
    Mutex mutex_;
    std::vector<telemetry::ThreadCpuClock> workers_ RIDGELINE_GUARDED_BY(mutex_);
};

}  // namespace ridgeline::app
