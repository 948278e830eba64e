#include "ridgeline/app/bench/own_cpu.h"

namespace ridgeline::app {

void OwnCpu::worker_started() {
    const MutexLock lock(mutex_);
    workers_.push_back(telemetry::ThreadCpuClock::of_this_thread());
}

OwnCpu::Sample OwnCpu::sample() {
    Sample now{render_.used_ns(), calls_.used_ns(), 0};
    const MutexLock lock(mutex_);
    for (const telemetry::ThreadCpuClock& worker : workers_) now.workers_ns += worker.used_ns();
    return now;
}

OwnCpuTime OwnCpu::take() {
    const Sample now = sample();
    const std::int64_t in_gl_ns = now.gl_ns - last_.gl_ns;
    const OwnCpuTime used{telemetry::milliseconds(now.render_ns - last_.render_ns - in_gl_ns),
                          telemetry::milliseconds(now.workers_ns - last_.workers_ns)};
    last_ = now;
    return used;
}

}  // namespace ridgeline::app
