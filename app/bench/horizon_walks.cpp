#include "ridgeline/app/bench/horizon_walks.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "ridgeline/app/bench/view_triangles.h"
#include "ridgeline/app/walk/course.h"
#include "ridgeline/app/walk/terrain_stage.h"
#include "ridgeline/app/walk/walk_telemetry.h"
#include "ridgeline/gl/fence.h"

namespace ridgeline::app {
namespace {

// Frames before the first, in which what the path's start wants may arrive; failed tiles never do.
constexpr int kMostArrivals = 500;
constexpr std::chrono::seconds kLongestFrame{60};
// Of summary.json, what is a variant's own where several share a process.
constexpr const char* kOwnMetrics[] = {
    "frame_ms.",          "selection_ms.", "request_to_ready_ms.",      "request_to_drawn_frames.",
    "per_frame.",         "tiles.",        "frames_with_missing_tiles", "ram_cache_bytes_max",
    "gpu_cache_bytes_max"};

struct Lane {
    WalkTelemetry telemetry{WalkTelemetry::Keep::frames};
    std::unique_ptr<TerrainStage> stage;
};

class SideBySide {
  public:
    SideBySide(const io::Store& store, jobs::JobSystem& jobs, const HorizonWalk& walk)
        : store_(store), jobs_(jobs), walk_(walk), course_(walk.path, walk.path.frame(0)) {}

    Result<void> open() {
        for (std::size_t i = 0; i < lanes_.size(); ++i) {
            StageOptions options;
            options.frame.size_px = walk_.lens.size_px;
            options.frame.gpu_cache_bytes = walk_.caches.gpu_bytes;
            options.pager.ram_bytes = walk_.caches.ram_bytes;
            options.pixel_error = walk_.pixel_error_px;
            options.horizon = kHorizonVariants[i].mode;
            options.pager.recorder = &lanes_[i].telemetry.recorder();
            auto stage = TerrainStage::create(store_, jobs_, options);
            if (!stage) return stage.error();
            lanes_[i].stage = std::move(*stage);
        }
        return {};
    }

    void run(const std::function<void()>& step) {
        for (Lane& lane : lanes_) arrive(lane);
        for (std::int64_t frame = 0; frame < walk_.frames; ++frame) {
            const auto at = frame * static_cast<std::int64_t>(walk_.path.frame_count()) / walk_.frames;
            // The frame before tells how fast the camera moves.
            course_.show_frame(std::max<std::int64_t>(at - 1, 0));
            course_.show_frame(at);
            // Each in its turn is the first.
            for (std::size_t i = 0; i < lanes_.size(); ++i)
                show(lanes_[(static_cast<std::size_t>(frame) + i) % lanes_.size()], frame, at);
            step();
        }
    }

    void report(Figures& figures) {
        for (std::size_t i = 0; i < lanes_.size(); ++i)
            report(lanes_[i], kHorizonVariants[i].on(walk_.name), figures);
        compare(figures);
    }

  private:
    // at: of the path's frames.
    StageMoment moment(std::int64_t frame, std::int64_t at) const {
        return {.number = static_cast<std::uint64_t>(frame),
                .camera = {course_.pose(), walk_.lens},
                .speed_m_per_s = course_.speed_m_per_s(),
                .turn_per_second = course_.turn_per_second(),
                .now = kHeadlessFrameTime * static_cast<double>(at),
                .daylight = {},
                .background = {}};
    }

    // What is drawn behind a frame's back would be counted as the next one's.
    static void finish_drawing() { gl::Fence::insert().wait(kLongestFrame); }

    void arrive(Lane& lane) {
        for (int i = 0; i < kMostArrivals; ++i) {
            lane.stage->show(moment(0, 0));
            finish_drawing();
            if (lane.stage->pager().settled()) break;
        }
        while (lane.stage->take_gpu_time()) {
        }
        lane.telemetry.start({});
    }

    void show(Lane& lane, std::int64_t frame, std::int64_t at) {
        lane.telemetry.resume();
        const StageReport report = lane.stage->show(moment(frame, at));
        finish_drawing();
        const Seconds time = kHeadlessFrameTime * static_cast<double>(at);
        lane.telemetry.add_frame(time.count(), course_.pose().eye_m, report, *lane.stage);
    }

    void report(Lane& lane, const std::string& variant, Figures& figures) const {
        const pager::PagerCounters tiles = lane.stage->pager().counters();
        lane.telemetry.finish(lane.stage->pager());
        figures.set(variant, "frames", static_cast<double>(walk_.frames));
        figures.set(variant, "pixel_error_px", walk_.pixel_error_px);
        figures.set(variant, "tiles_in", static_cast<double>(tiles.loaded));
        figures.set(variant, "tiles_out", static_cast<double>(tiles.evicted));
        figures.set(variant, "bytes_read", static_cast<double>(tiles.bytes_read));
        for (const auto& [name, value] : telemetry::metrics(lane.telemetry.recorder().summary()))
            if (std::ranges::any_of(kOwnMetrics, [&](const char* own) { return name.starts_with(own); }))
                figures.set(variant, name, value);
    }

    void compare(Figures& figures) const {
        const auto value = [&](const char* path_variant, const char* metric) {
            return *figures.find(walk_.name + "/" + path_variant, metric);
        };
        for (const HorizonVariant& variant : kHorizonVariants) {
            const std::string name = variant.on(walk_.name);
            const double frame_ms = value(variant.name, "frame_ms.mean");
            figures.set(name, "fps_mean", 1000.0 / frame_ms);
            figures.set(name, "fps_ratio", value("off", "frame_ms.mean") / frame_ms);
            figures.set(name, "fps_ratio_to_boxes", value("boxes", "frame_ms.mean") / frame_ms);
            figures.set(name, "tiles_ratio", value(variant.name, "tiles_in") / value("off", "tiles_in"));
            figures.set(name, "triangles_ratio",
                        value("off", "per_frame.triangles") / value(variant.name, "per_frame.triangles"));
        }
    }

    const io::Store& store_;
    jobs::JobSystem& jobs_;
    const HorizonWalk& walk_;
    Course course_;
    std::array<Lane, kHorizonVariants.size()> lanes_;
};

}  // namespace

Result<void> walk_side_by_side(const io::Store& store, jobs::JobSystem& jobs, const HorizonWalk& walk,
                               Figures& figures, const std::function<void()>& step) {
    SideBySide walks(store, jobs, walk);
    RIDGELINE_TRY(walks.open());
    walks.run(step);
    walks.report(figures);
    return {};
}

// Half a turn to either side in eleven seconds, up and down in seven: never the same pair twice on a round.
platform::ResolvedPath looking_about(const platform::ResolvedPath& path) {
    constexpr double kTurn_s = 11.0, kNod_s = 7.0;
    const auto swing = [](double time_s, double period_s) {
        return std::sin(2.0 * std::numbers::pi * time_s / period_s);
    };
    std::vector<platform::Pose> poses;
    for (std::size_t i = 0; i < path.frame_count(); ++i) {
        platform::Pose pose = path.frame(i);
        const double time_s = kHeadlessFrameTime.count() * static_cast<double>(i);
        pose.heading = pose.heading + Angle::from_degrees(180.0 * swing(time_s, kTurn_s));
        pose.pitch = Angle::from_degrees(-5.0 + 20.0 * swing(time_s, kNod_s));
        poses.push_back(pose);
    }
    return {std::move(poses), kHeadlessFrameTime, platform::PathEnd::hold};
}

std::optional<double> pixel_error_for(const io::Store& store, const HorizonWalk& walk, double triangles) {
    constexpr std::size_t kPoses = 32;
    constexpr double kLeast_px = 0.02;
    ViewTriangles views(store);
    const auto mean = [&](double pixel_error_px) {
        double sum = 0.0;
        for (std::size_t i = 0; i < kPoses; ++i)
            sum += views.count({walk.path.frame(i * walk.path.frame_count() / kPoses), walk.lens},
                               pixel_error_px);
        return sum / static_cast<double>(kPoses);
    };
    if (mean(kLeast_px) < triangles) return std::nullopt;
    return pixel_error_for(triangles, {kLeast_px, walk.pixel_error_px}, mean);
}

}  // namespace ridgeline::app
