// What a walk measures: CPU clocks of its threads, the record of each frame, the description of the run.
//
// Render thread, but for worker_started(), which each worker calls about itself.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "ridgeline/app/commands/walk_options.h"
#include "ridgeline/app/hud/hud.h"
#include "ridgeline/app/walk/stage.h"
#include "ridgeline/base/thread_annotations.h"
#include "ridgeline/telemetry/recorder.h"

namespace ridgeline::app {

class WalkTelemetry {
  public:
    // Frames are kept only for a walk that writes them.
    enum class Keep { nothing, frames };
    explicit WalkTelemetry(Keep keep);

    telemetry::Recorder& recorder() { return recorder_; }
    // Called by each worker as it starts and ends.
    void worker_started() RIDGELINE_EXCLUDES(mutex_);
    void worker_stopped() { recorder_.release_this_thread(); }

    void start(telemetry::RunDescription description);
    // The next frame begins here: what was since the last one is no part of it.
    void resume();
    // After the frame was presented. Returns its record, which stays until the next.
    const telemetry::FrameRecord& add_frame(double time_s, const glm::dvec3& eye_m, const StageReport& report,
                                            TerrainStage& stage);
    // What came between the frames since the last of them is no frame's.
    void leave_out();
    HudFigures figures(const TerrainStage& stage) const;
    // Of the last half second or so.
    HudCpu cpu() RIDGELINE_EXCLUDES(mutex_);

    // Ends the measured time.
    void finish(const pager::Pager& pager);
    Result<void> write(const std::filesystem::path& directory, const pager::Pager& pager);

  private:
    const Keep keep_;
    telemetry::Recorder recorder_;
    telemetry::FrameRecord record_;
    StageReport report_;
    double gpu_ms_ = 0.0;

    std::int64_t frames_ = 0;
    // As of the end of the last frame.
    std::int64_t frame_end_ns_ = 0;
    std::int64_t render_cpu_ns_ = 0;
    std::uint64_t bytes_read_ = 0;
    std::uint64_t imagery_requested_ = 0, imagery_loaded_ = 0;
    std::uint64_t heap_allocations_ = 0;
    telemetry::ThreadCpuClock render_clock_;

    struct ProcessSample {
        std::int64_t wall_ns = 0;
        std::int64_t rss_bytes = 0, handles = 0;
    };
    void look_at_process(std::int64_t wall_ns);
    ProcessSample process_;

    struct CpuSample {
        std::int64_t wall_ns = 0, process_ns = 0, render_ns = 0, workers_ns = 0;
    };
    CpuSample sample() RIDGELINE_EXCLUDES(mutex_);
    CpuSample cpu_sample_;
    HudCpu cpu_;
    Mutex mutex_;
    std::vector<telemetry::ThreadCpuClock> workers_ RIDGELINE_GUARDED_BY(mutex_);
};

}  // namespace ridgeline::app
