// Watches over a long walk that nothing grows: memory, the GPU's caches, handles, the CPU time of a frame.
//
// A sample a second, in memory that is taken at the start, so that watching does not grow either. The first
// quarter is warming up: caches fill, drivers compile. Over the rest each measure has a slope with its
// standard error (telemetry/trend.h). Wall time of a frame is told, but not judged: it tells as much of what
// else the machine does. Render thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "ridgeline/base/result.h"
#include "ridgeline/telemetry/frame_record.h"
#include "ridgeline/telemetry/trend.h"

namespace ridgeline::app {

// Since any one moment.
struct SoakClock {
    double wall_s = 0.0;
    double cpu_s = 0.0;  // of all threads
};

class SoakWatch {
  public:
    struct Second {
        double wall_s = 0.0;  // at its end
        double rss_bytes = 0.0, gpu_cache_bytes = 0.0, handles = 0.0;
        double cpu_ms = 0.0, frame_ms = 0.0;  // a frame, in the mean
        double frame_ms_max = 0.0;
        std::int64_t frames = 0;
        double rounds = 0.0;  // gone until then
    };

    // round_frames: after which the walk is where it was; 0: never.
    SoakWatch(const SoakClock& start, std::size_t usual_seconds, std::size_t round_frames = 0);

    // After each frame.
    void add(const SoakClock& now, const telemetry::FrameRecord& frame);

    const std::vector<Second>& seconds() const { return seconds_; }
    // A line a second, under a line of names.
    std::string csv() const;
    // A line for each measure: its mean, its slope and error an hour, and what they say. An error where there
    // are too few seconds to tell.
    Result<std::string> table() const;
    // An error names the first measure that rises.
    Result<void> verdict() const;

  private:
    Result<std::vector<telemetry::Trend>> trends() const;

    std::size_t round_frames_;
    SoakClock second_start_;
    Second second_;
    std::vector<Second> seconds_;
};

}  // namespace ridgeline::app
