#include "ridgeline/app/bench/stress_suite.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "ridgeline/app/bench/stress_paths.h"
#include "ridgeline/app/bench/stress_turn.h"
#include "ridgeline/app/bench/stress_walk.h"
#include "ridgeline/app/walk/course.h"
#include "ridgeline/app/walk/drawn_ground.h"

namespace ridgeline::app {
namespace {

Result<std::vector<StressPath>> chosen_paths(const io::Store& store, const std::optional<PathChoice>& path) {
    if (path) {
        auto course = resolve_course(store, *path, 1.0);
        if (!course) return course.error();
        return std::vector<StressPath>{{path_name(*path), std::move(*course)}};
    }
    DrawnGround ground(store, 1.0);
    auto paths = stress_paths(terrain_box(store.info(), 1.0), ground.function());
    if (ground.failure()) return *ground.failure();
    return paths;
}

Result<void> check_beside(const io::Store& store, const io::Store& beside) {
    const io::TerrainInfo &inner = store.info(), &outer = beside.info();
    const bool holds = outer.min_east_m() <= inner.min_east_m() && outer.max_east_m() >= inner.max_east_m() &&
                       outer.min_north_m() <= inner.min_north_m() &&
                       outer.max_north_m() >= inner.max_north_m();
    if (holds) return {};
    return Error{beside.directory().string() + ": does not hold the ground of " + store.directory().string() +
                 ", for --beside"};
}

std::vector<StressVariant> chosen_variants(const std::vector<std::string>& names) {
    std::vector<StressVariant> chosen;
    for (const StressVariant& variant : kStressVariants)
        if (names.empty() || std::ranges::find(names, variant.name) != names.end()) chosen.push_back(variant);
    return chosen;
}

struct Suite {
    StressGround ground;
    std::vector<StressVariant> variants;
    const StressSuiteOptions& options;
    Figures figures;
    std::function<void()> step;

    BenchWalk walk_of(StressPath path) const {
        return {std::move(path.name),   std::move(path.path),         options.frames,
                options.pixel_error_px, {.size_px = options.size_px}, options.caches};
    }

    Result<void> walk(const BenchWalk& walk) {
        for (const StressVariant& variant : variants)
            RIDGELINE_TRY(walk_stressed({ground, ground.store, walk, variant}, figures, step));
        if (!options.beside) return {};
        return walk_stressed({ground, *options.beside, walk, {.name = "beside"}}, figures, step);
    }

    Result<void> turn(const BenchWalk& walk) {
        const auto rate = disk_bytes_per_s(ground.store);
        if (!rate) return rate.error();
        figures.set("disk/warm", "bytes_per_s", *rate);
        for (const StressVariant& variant : variants)
            RIDGELINE_TRY(turn_round(ground, {walk, options.turns, *rate}, variant, figures, step));
        return {};
    }
};

}  // namespace

Result<Figures> run_stress_suite(const io::Store& store, const StressSuiteOptions& options) {
    if (options.beside) RIDGELINE_TRY(check_beside(store, *options.beside));
    auto paths = chosen_paths(store, options.path);
    if (!paths) return paths.error();
    const std::vector<StressVariant> variants = chosen_variants(options.variants);
    const auto count = static_cast<std::int64_t>(variants.size());
    const std::int64_t walks = static_cast<std::int64_t>(paths->size()) * (count + (options.beside ? 1 : 0));
    const std::int64_t total = walks * options.frames + count * options.turns;
    std::int64_t done = 0;
    jobs::JobSystem jobs;
    Suite suite{{store, jobs}, variants, options, {}, [&] {
                    if (options.progress) options.progress(++done, total);
                }};
    for (StressPath& path : *paths) {
        const BenchWalk walk = suite.walk_of(std::move(path));
        RIDGELINE_TRY(suite.walk(walk));
        // From the middle of the turns, or of the path that was asked for.
        if (walk.name == "turns" || paths->size() == 1) RIDGELINE_TRY(suite.turn(walk));
    }
    return std::move(suite.figures);
}

std::string stress_tables(const Figures& figures) {
    return figures.table("Frames; ratios to a twin without faults", "background_pixels",
                         {{"frame_ms.p50", "p50 ms"},
                          {"frame_ms.p99", "p99"},
                          {"frame_ms.p999", "p99.9"},
                          {"frame_ms.max", "max"},
                          {"frame_ms.p50_ratio", "p50 / twin"},
                          {"frame_ms.p99_ratio", "p99 / twin"},
                          {"selection_ms.mean", "selection ms"},
                          {"selection_ms.mean_ratio", "/ twin"},
                          {"frames_with_missing_tiles", "lacking"},
                          {"request_to_ready_ms.p50", "ready p50 ms"},
                          {"request_to_ready_ms.p99", "ready p99"}}) +
           figures.table("What must hold", "background_pixels",
                         {{"background_pixels", "background"},
                          {"bytes_over_budget", "over budget"},
                          {"failures.repeated", "repeated reads"},
                          {"failures.given_up", "failed tiles"},
                          {"failures.left", "left"},
                          {"rest.differing_pixels", "differing"},
                          {"eye_lift.frames", "lifts"},
                          {"eye_lift_m.max", "most m"},
                          {"ram_cache_bytes_max", "RAM MB", 1e6},
                          {"gpu_cache_bytes_max", "GPU MB", 1e6}}) +
           figures.table("After a turn by 180 degrees", "turn_floor_ratio.mean",
                         {{"turn_sharp_ms.mean", "sharp ms"},
                          {"turn_there_ms.mean", "there ms"},
                          {"turn_there_ms.max", "most"},
                          {"turn_floor_ms.mean", "floor ms"},
                          {"turn_floor_ratio.mean", "/ floor"},
                          {"turn_floor_ratio.max", "most / floor"},
                          {"turn_frames.mean", "frames"},
                          {"turn_bytes.mean", "MB", 1e6},
                          {"turn_missing.max", "missing"}});
}

Result<void> stress_verdict(const Figures& figures) {
    constexpr std::pair<const char*, const char*> kNothing[] = {
        {"background_pixels", "pixels of background where ground should be"},
        {"bytes_over_budget", "bytes over its caches"},
        {"turn_unfinished.max", "turns after which something was missing for a minute"},
        {"failures.left", "wanted tiles missing after the faults had ended"},
        {"rest.differing_pixels", "pixels other than without faults, after those had ended"}};
    for (const std::string& variant : figures.variants())
        for (const auto& [metric, what] : kNothing)
            if (const double* value = figures.find(variant, metric); value && *value != 0.0)
                return Error{variant + ": " + std::to_string(static_cast<std::int64_t>(*value)) + " " + what};
    return {};
}

}  // namespace ridgeline::app
