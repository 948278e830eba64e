#include "ridgeline/app/bench/stress_walk.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>

#include "ridgeline/app/bench/stress_look.h"

namespace ridgeline::app {
namespace {

enum Lane : std::size_t { kVariant, kTwin, kLanes };

// After the journey, until the last view has all it wants. Failed tiles are asked for again after two seconds
// of the walk's time, which passes quickly here.
constexpr int kMostFramesAfter = 600;
constexpr platform::Seconds kStepAfter{0.25};
// In a row: the GPU tells some frames late what ground was seen.
constexpr int kQuietFrames = 6;

// What was seen of the variant's frames.
struct Sights {
    std::int64_t background = 0;
    std::int64_t over_budget = 0;  // the most at once
    std::int64_t lifted_frames = 0;
    double highest_lift_m = 0.0;
};

// How the last view came to rest.
struct Rest {
    std::int64_t missing = 0;
    gl::Image picture;
};

class PairWalk {
  public:
    explicit PairWalk(const StressPair& pair) : pair_(pair), steps_(pair.walk) {}

    Result<void> open() {
        for (const Lane lane : {kVariant, kTwin}) {
            StageOptions options = pair_.walk.stage_options();
            if (lane == kVariant) stress(options);
            const io::Store& store = lane == kVariant ? pair_.on : pair_.ground.store;
            auto opened = WalkLane::open(store, pair_.ground.jobs, options);
            if (!opened) return opened.error();
            lanes_[lane] = std::move(*opened);
        }
        return {};
    }

    void run(const std::function<void()>& step) {
        steps_.go_to(0);
        for (const Lane lane : {kVariant, kTwin}) lanes_[lane]->arrive(moment());
        for (std::int64_t frame = 0; frame < pair_.walk.frames; ++frame) {
            steps_.go_to(frame);
            // Each in its turn is the first.
            for (std::size_t i = 0; i < kLanes; ++i) show((static_cast<std::size_t>(frame) + i) % kLanes);
            step();
        }
    }

    void report(Figures& figures) {
        const std::string name = pair_.walk.name + "/" + pair_.variant.name;
        Figures twin;
        lanes_[kVariant]->report(name, figures);
        lanes_[kTwin]->report(name, twin);
        const auto set = [&](const char* metric, auto value) {
            figures.set(name, metric, static_cast<double>(value));
        };
        set("frames", pair_.walk.frames);
        for (const char* metric :
             {"frame_ms.mean", "frame_ms.p50", "frame_ms.p99", "selection_ms.mean", "selection_ms.p50"})
            set((std::string(metric) + "_ratio").c_str(),
                *figures.find(name, metric) / *twin.find(name, metric));
        set("background_pixels", sights_.background);
        set("bytes_over_budget", sights_.over_budget);
        set("eye_lift.frames", sights_.lifted_frames);
        set("eye_lift_m.max", sights_.highest_lift_m);
        report_rest(name, figures);
    }

  private:
    void stress(StageOptions& options) const {
        const CacheSizes caches = pair_.variant.caches(pair_.walk.caches);
        options.frame.gpu_cache_bytes = caches.gpu_bytes;
        options.pager.ram_bytes = caches.ram_bytes;
        options.pager.fault = pair_.variant.fault;
        options.pager.fault.until_frame = static_cast<std::uint32_t>(pair_.walk.frames);
    }

    StageMoment moment() const {
        StageMoment moment = steps_.moment();
        moment.background = kStressBackground;
        return moment;
    }

    void show(std::size_t lane) {
        const StageReport report = lanes_[lane]->show(moment()).report;
        if (lane != kVariant) return;
        TerrainStage& stage = lanes_[kVariant]->stage();
        sights_.background += wrong_background(gl::read_image(stage.target()), moment(), report);
        sights_.over_budget =
            std::max(sights_.over_budget, bytes_over_budget(stage, pair_.variant.caches(pair_.walk.caches)));
        sights_.lifted_frames += report.eye_lift_m > 0.0;
        sights_.highest_lift_m = std::max(sights_.highest_lift_m, report.eye_lift_m);
    }

    // Until nothing is missing, or, where nothing failed, until nothing can come any more.
    Rest come_to_rest(Lane lane) {
        StageMoment last = moment();
        last.speed_m_per_s = 0.0;
        last.turn_per_second = Angle();
        const bool can_fail = lane == kVariant && pair_.variant.fault.any();
        Rest rest;
        int quiet = 0;
        for (int i = 0; i < kMostFramesAfter && quiet < kQuietFrames; ++i) {
            ++last.number;
            last.now += kStepAfter;
            const StageReport report = lanes_[lane]->show(last).report;
            rest.missing = missing_tiles(lanes_[lane]->stage(), report);
            const bool rests = at_rest(lanes_[lane]->stage()) && (rest.missing == 0 || !can_fail);
            quiet = rests ? quiet + 1 : 0;
        }
        rest.picture = gl::read_image(lanes_[lane]->stage().target());
        return rest;
    }

    void report_rest(const std::string& name, Figures& figures) {
        const Rest variant = come_to_rest(kVariant), twin = come_to_rest(kTwin);
        const pager::PagerCounters tiles = lanes_[kVariant]->stage().pager().counters();
        const auto set = [&](const char* metric, auto value) {
            figures.set(name, metric, static_cast<double>(value));
        };
        set("failures.repeated", tiles.retried);
        set("failures.given_up", tiles.failed);
        set("failures.left", std::max<std::int64_t>(0, variant.missing - twin.missing));
        set("rest.missing", variant.missing);
        // With other caches, or other ground, other pictures are right.
        if (pair_.variant.cache_bytes == 0 && &pair_.on == &pair_.ground.store)
            set("rest.differing_pixels", differing_pixels(variant.picture, twin.picture));
    }

    const StressPair& pair_;
    WalkSteps steps_;
    std::array<std::unique_ptr<WalkLane>, kLanes> lanes_;
    Sights sights_;
};

}  // namespace

Result<void> walk_stressed(const StressPair& pair, Figures& figures, const std::function<void()>& step) {
    PairWalk walk(pair);
    RIDGELINE_TRY(walk.open());
    walk.run(step);
    walk.report(figures);
    return {};
}

}  // namespace ridgeline::app
