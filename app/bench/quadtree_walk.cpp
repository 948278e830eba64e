#include "ridgeline/app/bench/quadtree_walk.h"

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <utility>

namespace ridgeline::app {
namespace {

struct Variant {
    const char* name;
    render::Surface surface;
    render::LodBy lod;
};
constexpr std::size_t kByGpu = 0, kByCpu = 1;
constexpr std::array<Variant, 4> kVariants = {
    {{"quadtree_gpu", render::Surface::quadtree, render::LodBy::gpu},
     {"quadtree_cpu", render::Surface::quadtree, render::LodBy::cpu},
     {"mesh", render::Surface::mesh, render::LodBy::gpu},
     {"disc", render::Surface::disc, render::LodBy::gpu}}};
constexpr const char* kBaseline = "quadtree_cpu";
// So many pixels of error for one of the walk's, for cells alone.
constexpr std::array<double, 5> kCellErrors = {32.0, 8.0, 2.0, 1.0, 0.5};
constexpr std::int64_t kMostStillFrames = 60;
// Longer than a tile takes to turn from its parent's look.
constexpr platform::Seconds kTurned{1.0};
// Until counts of cells have come back from the GPU.
constexpr int kWarmFrames = 4;

struct Sum {
    double frame_ms = 0.0, process_ms = 0.0, render_ms = 0.0;
    OwnCpuTime own;

    void add(const LaneFrame& frame, const OwnCpuTime& used) {
        frame_ms += frame.frame_ms;
        process_ms += frame.process_ms;
        render_ms += frame.render_ms;
        own += used;
    }
};

Result<std::unique_ptr<WalkLane>> open_lane(const QuadtreeBench& bench, const Variant& variant) {
    StageOptions options = bench.walk.stage_options();
    if (render::samples_heights(variant.surface)) options.frame.surfaces = render::Surfaces::all;
    options.frame.quadtree.lod = variant.lod;
    auto lane = WalkLane::open(bench.store, bench.jobs, options);
    if (!lane) return lane.error();
    if (variant.surface == render::Surface::quadtree) (*lane)->stage().time_passes();
    return lane;
}

StageMoment moment_of(const WalkSteps& steps, const Variant& variant) {
    StageMoment moment = steps.moment();
    moment.surface = variant.surface;
    return moment;
}

class SurfaceWalk {
  public:
    explicit SurfaceWalk(const QuadtreeBench& bench) : bench_(bench), steps_(bench.walk) {}

    Result<void> open() {
        for (std::size_t i = 0; i < kVariants.size(); ++i) {
            auto lane = open_lane(bench_, kVariants[i]);
            if (!lane) return lane.error();
            lanes_[i] = std::move(*lane);
        }
        return {};
    }

    void run() {
        steps_.go_to(0);
        for (std::size_t i = 0; i < lanes_.size(); ++i) lanes_[i]->arrive(moment_of(steps_, kVariants[i]));
        // Shapes of the tiles that were there before the first frame are none of it.
        if (auto* clock = lanes_[kByGpu]->stage().pass_clock()) clock->clear();
        for (std::int64_t frame = 0; frame < bench_.walk.frames; ++frame) {
            steps_.go_to(frame);
            // Each in its turn is the first.
            for (std::size_t i = 0; i < lanes_.size(); ++i)
                show((static_cast<std::size_t>(frame) + i) % lanes_.size());
            bench_.step();
        }
    }

    // In which the quadtree had the most cells.
    std::int64_t busiest_frame() const { return busiest_; }

    void report(Figures& figures) {
        for (std::size_t i = 0; i < lanes_.size(); ++i) report(i, figures);
        compare(figures);
    }

  private:
    std::string name_of(std::size_t variant) const {
        return bench_.walk.name + "/" + kVariants[variant].name;
    }

    void show(std::size_t variant) {
        bench_.cpu.take();
        const LaneFrame frame = lanes_[variant]->show(moment_of(steps_, kVariants[variant]));
        sums_[variant].add(frame, bench_.cpu.take());
        if (variant != kByGpu || frame.report.surface.triangles <= most_triangles_) return;
        most_triangles_ = frame.report.surface.triangles;
        busiest_ = steps_.frame();
    }

    void report(std::size_t variant, Figures& figures) {
        const Sum& sum = sums_[variant];
        const std::string name = name_of(variant);
        const auto frames = static_cast<double>(bench_.walk.frames);
        figures.set(name, "frames", frames);
        figures.set(name, "pixel_error_px", bench_.walk.pixel_error_px);
        lanes_[variant]->report(name, figures);
        figures.set(name, "fps_mean", 1000.0 * frames / sum.frame_ms);
        figures.set(name, "cpu_percent.process", 100.0 * sum.process_ms / sum.frame_ms);
        figures.set(name, "cpu_percent.render", 100.0 * sum.render_ms / sum.frame_ms);
        figures.set(name, "cpu_percent.own", 100.0 * sum.own.all_ms() / sum.frame_ms);
        if (const double* gpu_ms = figures.find(name, "gpu_ms.mean"))
            figures.set(name, "gpu_percent", 100.0 * *gpu_ms * frames / sum.frame_ms);
        figures.set(name, "own_cpu_ms.render", sum.own.render_ms / frames);
        figures.set(name, "own_cpu_ms.workers", sum.own.workers_ms / frames);
        figures.set(name, "own_cpu_ms.mean", sum.own.all_ms() / frames);
        if (variant == kByGpu) report_passes(name, figures);
    }

    void report_passes(const std::string& name, Figures& figures) {
        const render::QuadtreePassClock& clock = *lanes_[kByGpu]->stage().pass_clock();
        double all_ms = 0.0;
        for (std::size_t i = 0; i < render::kQuadtreePasses; ++i) {
            const auto pass = static_cast<render::QuadtreePass>(i);
            figures.set(name, std::string("pass_ms.") + render::name_of(pass), clock.mean_ms(pass));
            all_ms += clock.mean_ms(pass);
        }
        figures.set(name, "pass_ms.all", all_ms);
    }

    void compare(Figures& figures) const {
        const auto value = [&](const std::string& variant, const char* metric) {
            return *figures.find(bench_.walk.name + "/" + variant, metric);
        };
        for (const Variant& variant : kVariants) {
            const std::string name = bench_.walk.name + "/" + variant.name;
            figures.set(name, "own_cpu_ratio",
                        value(variant.name, "own_cpu_ms.mean") / value(kBaseline, "own_cpu_ms.mean"));
            figures.set(name, "fps_ratio", value(variant.name, "fps_mean") / value("mesh", "fps_mean"));
        }
    }

    const QuadtreeBench& bench_;
    WalkSteps steps_;
    std::array<std::unique_ptr<WalkLane>, kVariants.size()> lanes_;
    std::array<Sum, kVariants.size()> sums_;
    std::uint64_t most_triangles_ = 0;
    std::int64_t busiest_ = 0;
};

std::int64_t frames_still(const BenchWalk& walk) { return std::min(walk.frames, kMostStillFrames); }

// One number of cells, by the GPU and by the CPU in turn.
class StillView {
  public:
    StillView(const QuadtreeBench& bench, std::array<std::unique_ptr<WalkLane>, 2>& lanes, std::int64_t frame)
        : bench_(bench), lanes_(lanes), steps_(bench.walk) {
        steps_.go_to(frame);
    }

    // Once more when all that has come looks like itself.
    void arrive() {
        for (const platform::Seconds passed : {platform::Seconds(0.0), kTurned}) {
            passed_ = passed;
            for (std::size_t i = 0; i < lanes_.size(); ++i) lanes_[i]->arrive(moment(i));
        }
    }

    void run(double cell_error, Figures& figures) {
        std::array<Sum, 2> sums;
        for (auto& lane : lanes_) lane->stage().set_cell_pixel_error(cell_error * bench_.walk.pixel_error_px);
        for (int i = 0; i < kWarmFrames; ++i) show_both(sums);
        sums = {};
        for (std::int64_t i = 0; i < frames_still(bench_.walk); ++i) {
            show_both(sums);
            bench_.step();
        }
        for (std::size_t i = 0; i < lanes_.size(); ++i) report(i, cell_error, sums[i], figures);
    }

  private:
    StageMoment moment(std::size_t variant) const {
        StageMoment moment = moment_of(steps_, kVariants[variant]);
        moment.now += passed_;
        return moment;
    }

    void show_both(std::array<Sum, 2>& sums) {
        const auto number = static_cast<std::uint64_t>(shown_++);
        for (std::size_t i = 0; i < lanes_.size(); ++i) {
            StageMoment shown = moment(i);
            shown.number = number;
            bench_.cpu.take();
            const LaneFrame frame = lanes_[i]->show(shown);
            sums[i].add(frame, bench_.cpu.take());
            triangles_[i] = static_cast<double>(frame.report.surface.triangles);
        }
    }

    void report(std::size_t variant, double cell_error, const Sum& sum, Figures& figures) const {
        std::string error = std::to_string(cell_error);
        error.erase(error.find_last_not_of('0') + 1);
        if (error.ends_with('.')) error.pop_back();
        const std::string name = std::string(variant == kByGpu ? "still/gpu-" : "still/cpu-") + error;
        const auto frames = static_cast<double>(frames_still(bench_.walk));
        figures.set(name, "cell_pixel_error_px", cell_error * bench_.walk.pixel_error_px);
        figures.set(name, "triangles", triangles_[variant]);
        figures.set(name, "fps_mean", 1000.0 * frames / sum.frame_ms);
        figures.set(name, "own_cpu_ms.render", sum.own.render_ms / frames);
        figures.set(name, "own_cpu_ms.workers", sum.own.workers_ms / frames);
        figures.set(name, "own_cpu_ms.mean", sum.own.all_ms() / frames);
    }

    const QuadtreeBench& bench_;
    std::array<std::unique_ptr<WalkLane>, 2>& lanes_;
    WalkSteps steps_;
    std::array<double, 2> triangles_{};
    std::int64_t shown_ = 0;
    platform::Seconds passed_{0.0};
};

}  // namespace

Result<std::int64_t> walk_surfaces(const QuadtreeBench& bench, Figures& figures) {
    SurfaceWalk walk(bench);
    RIDGELINE_TRY(walk.open());
    walk.run();
    walk.report(figures);
    return walk.busiest_frame();
}

std::int64_t still_frames(const BenchWalk& walk) {
    return frames_still(walk) * static_cast<std::int64_t>(kCellErrors.size());
}

Result<void> stand_still(const QuadtreeBench& bench, std::int64_t frame, Figures& figures) {
    std::array<std::unique_ptr<WalkLane>, 2> lanes;
    for (const std::size_t i : {kByGpu, kByCpu}) {
        auto lane = open_lane(bench, kVariants[i]);
        if (!lane) return lane.error();
        lanes[i] = std::move(*lane);
    }
    StillView view(bench, lanes, frame);
    view.arrive();
    for (const double cell_error : kCellErrors) view.run(cell_error, figures);
    return {};
}

}  // namespace ridgeline::app
