#include "ridgeline/jobs/job_system.h"

#include <algorithm>
#include <string>
#include <thread>

#include "ridgeline/base/thread_role.h"
#include "ridgeline/jobs/job_core.h"

namespace ridgeline::jobs {

int JobSystemOptions::default_workers() {
    return std::max(1, static_cast<int>(std::thread::hardware_concurrency()) - 1);
}

JobSystem::JobSystem(const JobSystemOptions& options) : core_(std::make_shared<JobCore>(options.workers)) {
    RIDGELINE_CHECK(options.workers >= 1);
    for (int worker = 0; worker < options.workers; ++worker) {
        threads_.emplace_back(
            [core = core_.get(), worker, start = options.on_worker_start, stop = options.on_worker_stop] {
                set_thread_role(ThreadRole::worker, ("worker " + std::to_string(worker)).c_str());
                if (start) start(worker);
                core->work();
                if (stop) stop(worker);
            });
    }
    core_->wait_for_workers();
}

JobSystem::~JobSystem() {
    core_->stop();
    for (auto& thread : threads_) thread.join();
    const Statistics end = statistics();
    RIDGELINE_CHECK(end.submitted == end.finished && end.continuations_waiting == 0 && end.ranges_open == 0);
}

int JobSystem::worker_count() const { return core_->worker_count(); }

JobSystem::Statistics JobSystem::statistics() const { return core_->statistics(); }

void JobSystem::wait(Counter& counter, Help help) { core_->wait(counter, help); }

void JobSystem::enqueue(Job&& job, Counter* counter, Priority priority) {
    core_->enqueue(std::move(job), counter, priority);
}

void JobSystem::continue_after(Counter& after, Job&& job, Counter* counter, Priority priority) {
    core_->continue_after(after, std::move(job), counter, priority);
}

void JobSystem::run_range(const ParallelRange::Shape& shape, ParallelRange::Participate participate,
                          void* body, Priority priority) {
    core_->run_range(shape, participate, body, priority);
}

}  // namespace ridgeline::jobs

#if defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define RIDGELINE_THREAD_SANITIZER
#endif
#elif defined(__SANITIZE_THREAD__)
#define RIDGELINE_THREAD_SANITIZER
#endif
#if defined(RIDGELINE_THREAD_SANITIZER)
// The queue reuses its blocks under fences, which the thread sanitizer does not follow. What is handed over
// through the queue is published by a store that it does follow, so races on it are still found.
extern "C" const char* __tsan_default_suppressions() { return "race:moodycamel::ConcurrentQueue\n"; }
#endif
