#include "ridgeline/app/bench/horizon_suite.h"

#include <array>

#include "ridgeline/app/bench/horizon_views.h"
#include "ridgeline/app/bench/horizon_walks.h"
#include "ridgeline/app/walk/course.h"

namespace ridgeline::app {
namespace {

struct Height {
    double above_ground_m;
    const char* name;
};
constexpr std::array<Height, 4> kHeights = {{{2.0, "2m"}, {30.0, "30m"}, {200.0, "200m"}, {1000.0, "1000m"}}};

Result<std::vector<BenchWalk>> walks_of(const io::Store& store, const HorizonSuiteOptions& options) {
    auto path = resolve_course(store, options.path, 1.0);
    if (!path) return path.error();
    const BenchWalk walk{path_name(options.path),      *path,         options.frames, options.pixel_error_px,
                         {.size_px = options.size_px}, options.caches};
    std::vector<BenchWalk> walks = {walk, walk};
    walks.back().name = "look";
    walks.back().path = looking_about(walk.path);
    if (const auto dense_px = pixel_error_for(store, walk, options.dense_triangles)) {
        walks.push_back(walk);
        walks.back().name = "dense";
        walks.back().pixel_error_px = *dense_px;
    }
    return walks;
}

// What tells walks from views.
constexpr const char* kOfWalks = "frames";
constexpr const char* kOfViews = "views";

}  // namespace

Result<Figures> run_horizon_suite(const io::Store& store, const HorizonSuiteOptions& options) {
    const auto walks = walks_of(store, options);
    if (!walks) return walks.error();
    const std::int64_t total = static_cast<std::int64_t>(walks->size()) * options.frames +
                               static_cast<std::int64_t>(kHeights.size()) * options.views;
    std::int64_t done = 0;
    const auto step = [&] {
        if (options.progress) options.progress(++done, total);
    };
    Figures figures;
    jobs::JobSystem jobs;
    for (const BenchWalk& walk : *walks) RIDGELINE_TRY(walk_side_by_side(store, jobs, walk, figures, step));
    HorizonViewOptions view_options;
    view_options.views = options.views;
    view_options.lens.size_px = options.size_px;
    view_options.pixel_error_px = options.pixel_error_px;
    view_options.seed = options.seed;
    HorizonViews views(store, view_options);
    for (const Height& height : kHeights)
        RIDGELINE_TRY(views.judge(height.above_ground_m, height.name, figures, step));
    return figures;
}

std::string horizon_tables(const Figures& figures) {
    return figures.table("Paged on the way (the paper's Table 2)", kOfWalks,
                         {{"tiles_in", "tiles in"},
                          {"tiles_out", "tiles out"},
                          {"bytes_read", "MB read", 1e6},
                          {"tiles_ratio", "in / off"}}) +
           figures.table("Frames (the paper's Table 3)", kOfWalks,
                         {{"fps_mean", "fps"},
                          {"per_frame.triangles", "K triangles", 1e3},
                          {"per_frame.nodes_drawn", "nodes"},
                          {"fps_ratio", "fps / off"},
                          {"fps_ratio_to_boxes", "fps / boxes"},
                          {"triangles_ratio", "triangles, off /"},
                          {"selection_ms.mean", "selection ms"},
                          {"selection_ms.p99", "p99"},
                          {"pixel_error_px", "pixel error"}}) +
           figures.table("Hidden nodes, by the oracle", kOfViews,
                         {{"oracle_hidden_share", "hidden culled %", 0.01},
                          {"wrongly_culled", "wrongly"},
                          {"per_frame.nodes_drawn", "nodes"},
                          {"nodes_visible", "seen"},
                          {"per_frame.triangles", "K triangles", 1e3},
                          {"triangles_ratio", "off /"},
                          {"oracle_triangles_ratio", "at most"},
                          {"selection_ms.mean", "selection ms"},
                          {"selection_ms.p99", "p99"}});
}

std::int64_t wrongly_culled(const Figures& figures) {
    double sum = 0.0;
    for (const Height& height : kHeights)
        for (const HorizonVariant& variant : kHorizonVariants)
            if (const double* wrong = figures.find(variant.on(height.name), "wrongly_culled")) sum += *wrong;
    return static_cast<std::int64_t>(sum);
}

}  // namespace ridgeline::app
