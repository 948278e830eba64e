#include "ridgeline/app/bench/walk_lane.h"

#include <algorithm>
#include <utility>

#include "ridgeline/gl/fence.h"
#include "ridgeline/telemetry/clock.h"

namespace ridgeline::app {
namespace {

// Frames before the first, in which what the path's start wants may arrive; failed tiles never do.
constexpr int kMostArrivals = 500;
// In a row without anything on its way: what the GPU saw of the first ones may ask for more.
constexpr int kQuietArrivals = 4;
constexpr std::chrono::seconds kLongestFrame{60};
// Of summary.json, what is a variant's own where several share a process.
constexpr const char* kOwnMetrics[] = {"frame_ms.",
                                       "selection_ms.",
                                       "gpu_ms.",
                                       "request_to_ready_ms.",
                                       "request_to_drawn_frames.",
                                       "per_frame.",
                                       "tiles.",
                                       "frames_with_missing_tiles",
                                       "frames_with_missing_imagery",
                                       "frames_with_missing_heights",
                                       "ram_cache_bytes_max",
                                       "gpu_cache_bytes_max"};

// What is drawn behind a frame's back would be counted as the next one's.
void finish_drawing() { gl::Fence::insert().wait(kLongestFrame); }

}  // namespace

std::string path_name(const PathChoice& path) {
    if (path.kind == PathChoice::Kind::ground) return "ground";
    if (path.kind == PathChoice::Kind::orbit) return "orbit";
    return "path-" + path.file.stem().string();
}

StageOptions BenchWalk::stage_options() const {
    StageOptions options;
    options.frame.size_px = lens.size_px;
    options.frame.gpu_cache_bytes = caches.gpu_bytes;
    options.pager.ram_bytes = caches.ram_bytes;
    options.pixel_error = pixel_error_px;
    return options;
}

void WalkSteps::go_to(std::int64_t frame) {
    frame_ = frame;
    at_ = frame * static_cast<std::int64_t>(walk_.path.frame_count()) / walk_.frames;
    // The frame before tells how fast the camera moves.
    course_.show_frame(std::max<std::int64_t>(at_ - 1, 0));
    course_.show_frame(at_);
}

StageMoment WalkSteps::moment() const {
    return {.number = static_cast<std::uint64_t>(frame_),
            .camera = {course_.pose(), walk_.lens},
            .speed_m_per_s = course_.speed_m_per_s(),
            .turn_per_second = course_.turn_per_second(),
            .now = kHeadlessFrameTime * static_cast<double>(at_),
            .daylight = {},
            .background = {}};
}

Result<std::unique_ptr<WalkLane>> WalkLane::open(const io::Store& store, jobs::JobSystem& jobs,
                                                 StageOptions options) {
    std::unique_ptr<WalkLane> lane(new WalkLane);
    options.pager.recorder = &lane->telemetry_.recorder();
    auto stage = TerrainStage::create(store, jobs, options);
    if (!stage) return stage.error();
    lane->stage_ = std::move(*stage);
    return lane;
}

StageReport WalkLane::arrive(const StageMoment& moment) {
    StageReport sum;
    int quiet = 0;
    for (int i = 0; i < kMostArrivals; ++i) {
        StageReport report = stage_->show(moment);
        report.bytes_uploaded += sum.bytes_uploaded;
        report.imagery_bytes_uploaded += sum.imagery_bytes_uploaded;
        report.heights_bytes_uploaded += sum.heights_bytes_uploaded;
        sum = report;
        finish_drawing();
        quiet = stage_->pager().settled() ? quiet + 1 : 0;
        if (quiet == kQuietArrivals) break;
    }
    while (stage_->take_gpu_time()) {
    }
    telemetry_.start({});
    return sum;
}

LaneFrame WalkLane::show(const StageMoment& moment, const std::function<void()>& also) {
    telemetry_.resume();
    const std::int64_t process_ns = telemetry::process_cpu_ns();
    const StageReport report = stage_->show(moment);
    if (also) also();
    finish_drawing();
    const double process_ms = telemetry::milliseconds(telemetry::process_cpu_ns() - process_ns);
    const telemetry::FrameRecord& record =
        telemetry_.add_frame(moment.now.count(), moment.camera.pose.eye_m, report, *stage_);
    return {report, record.frame_ms, process_ms, record.cpu_render_ms};
}

void WalkLane::report(const std::string& variant, Figures& figures) {
    const pager::PagerCounters tiles = stage_->pager().counters();
    telemetry_.finish(stage_->pager());
    figures.set(variant, "tiles_in", static_cast<double>(tiles.loaded));
    figures.set(variant, "tiles_out", static_cast<double>(tiles.evicted));
    figures.set(variant, "bytes_read", static_cast<double>(tiles.bytes_read));
    for (const auto& [name, value] : telemetry::metrics(telemetry_.recorder().summary()))
        if (std::ranges::any_of(kOwnMetrics, [&](const char* own) { return name.starts_with(own); }))
            figures.set(variant, name, value);
}

}  // namespace ridgeline::app
