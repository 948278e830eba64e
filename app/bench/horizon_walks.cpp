#include "ridgeline/app/bench/horizon_walks.h"

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "ridgeline/app/bench/view_triangles.h"
#include "ridgeline/app/walk/course.h"

namespace ridgeline::app {
namespace {

class SideBySide {
  public:
    SideBySide(const io::Store& store, jobs::JobSystem& jobs, const BenchWalk& walk)
        : store_(store), jobs_(jobs), walk_(walk), steps_(walk) {}

    Result<void> open() {
        for (std::size_t i = 0; i < lanes_.size(); ++i) {
            StageOptions options = walk_.stage_options();
            options.horizon = kHorizonVariants[i].mode;
            auto lane = WalkLane::open(store_, jobs_, options);
            if (!lane) return lane.error();
            lanes_[i] = std::move(*lane);
        }
        return {};
    }

    void run(const std::function<void()>& step) {
        steps_.go_to(0);
        for (auto& lane : lanes_) lane->arrive(steps_.moment());
        for (std::int64_t frame = 0; frame < walk_.frames; ++frame) {
            steps_.go_to(frame);
            // Each in its turn is the first.
            for (std::size_t i = 0; i < lanes_.size(); ++i)
                lanes_[(static_cast<std::size_t>(frame) + i) % lanes_.size()]->show(steps_.moment());
            step();
        }
    }

    void report(Figures& figures) {
        for (std::size_t i = 0; i < lanes_.size(); ++i) {
            const std::string variant = kHorizonVariants[i].on(walk_.name);
            figures.set(variant, "frames", static_cast<double>(walk_.frames));
            figures.set(variant, "pixel_error_px", walk_.pixel_error_px);
            lanes_[i]->report(variant, figures);
        }
        compare(figures);
    }

  private:
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
    const BenchWalk& walk_;
    WalkSteps steps_;
    std::array<std::unique_ptr<WalkLane>, kHorizonVariants.size()> lanes_;
};

}  // namespace

Result<void> walk_side_by_side(const io::Store& store, jobs::JobSystem& jobs, const BenchWalk& walk,
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

std::optional<double> pixel_error_for(const io::Store& store, const BenchWalk& walk, double triangles) {
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
