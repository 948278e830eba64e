// One variant of a walk among several that take turns frame by frame: a stage of its own, and what it
// measured.
//
// Frames wait for the GPU, so that none is paid for by the next one's variant. Render thread, with a GL
// context current; store and jobs outlive it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "ridgeline/app/bench/figures.h"
#include "ridgeline/app/options.h"
#include "ridgeline/app/walk/course.h"
#include "ridgeline/app/walk/stage.h"
#include "ridgeline/app/walk/walk_telemetry.h"
#include "ridgeline/platform/path.h"

namespace ridgeline::app {

// ground, orbit, path-FILE: so that no file takes another walk's name.
std::string path_name(const PathChoice& path);

struct BenchWalk {
    std::string name;  // PATH of PATH/VARIANT
    platform::ResolvedPath path;
    std::int64_t frames = 300;  // spread evenly over the path, which is walked as fast as ever
    double pixel_error_px = 1.0;
    platform::Lens lens{};
    CacheSizes caches{};

    StageOptions stage_options() const;
};

// The frames of a walk, one after another.
class WalkSteps {
  public:
    explicit WalkSteps(const BenchWalk& walk) : walk_(walk), course_(walk.path, walk.path.frame(0)) {}

    // Counts from 0.
    void go_to(std::int64_t frame);
    std::int64_t frame() const { return frame_; }
    StageMoment moment() const;

  private:
    const BenchWalk& walk_;
    Course course_;
    std::int64_t frame_ = 0;
    std::int64_t at_ = 0;  // of the path's frames
};

// What one frame took.
struct LaneFrame {
    StageReport report;
    double frame_ms = 0.0;
    // CPU time in it: of all threads, and of the render thread.
    double process_ms = 0.0;
    double render_ms = 0.0;
};

class WalkLane {
  public:
    static Result<std::unique_ptr<WalkLane>> open(const io::Store& store, jobs::JobSystem& jobs,
                                                  StageOptions options);

    // Shows it until nothing more can arrive, or too long; the measured time begins after that. Returns the
    // last frame's report with the bytes of all of them.
    StageReport arrive(const StageMoment& moment);
    // `also` is part of the frame; may be empty.
    LaneFrame show(const StageMoment& moment, const std::function<void()>& also = {});

    // Ends the measured time, and takes over what of a walk's summary is a variant's own where several share
    // a process; tiles_in, tiles_out, bytes_read.
    void report(const std::string& variant, Figures& figures);

    TerrainStage& stage() { return *stage_; }

  private:
    WalkLane() = default;

    WalkTelemetry telemetry_{WalkTelemetry::Keep::frames};
    std::unique_ptr<TerrainStage> stage_;
};

}  // namespace ridgeline::app
