#include "ridgeline/app/bench/quadtree_suite.h"

#include "ridgeline/app/bench/quadtree_walk.h"
#include "ridgeline/app/walk/course.h"

namespace ridgeline::app {

Result<Figures> run_quadtree_suite(const io::Store& store, const QuadtreeSuiteOptions& options) {
    if (!gl::CallClock::available())
        return Error{
            "suite quadtree: this build's OpenGL loader cannot tell time in its calls: build it with "
            "glad's generator (--debug)"};
    auto course = resolve_course(store, options.path, 1.0);
    if (!course) return course.error();
    const BenchWalk walk{path_name(options.path), std::move(*course),           options.frames,
                         options.pixel_error_px,  {.size_px = options.size_px}, options.caches};
    const std::int64_t total = walk.frames + still_frames(walk);
    std::int64_t done = 0;
    OwnCpu cpu;
    jobs::JobSystem jobs({.on_worker_start = [&cpu](int) { cpu.worker_started(); }});
    const QuadtreeBench bench{store, jobs, cpu, walk, [&] {
                                  if (options.progress) options.progress(++done, total);
                              }};
    Figures figures;
    const auto busiest = walk_surfaces(bench, figures);
    if (!busiest) return busiest.error();
    RIDGELINE_TRY(stand_still(bench, *busiest, figures));
    return figures;
}

std::string quadtree_tables(const Figures& figures) {
    return figures.table("Frames (the paper's Table 1)", "gpu_percent",
                         {{"fps_mean", "fps"},
                          {"fps_ratio", "fps / mesh"},
                          {"cpu_percent.process", "CPU %"},
                          {"cpu_percent.own", "own CPU %"},
                          {"gpu_percent", "GPU %"},
                          {"gpu_ms.mean", "GPU ms"},
                          {"per_frame.triangles", "K triangles", 1e3},
                          {"own_cpu_ms.mean", "own CPU ms"},
                          {"own_cpu_ms.render", "render"},
                          {"own_cpu_ms.workers", "workers"},
                          {"own_cpu_ratio", "/ quadtree_cpu"}}) +
           figures.table("Passes, ms", "pass_ms.all",
                         {{"pass_ms.shapes", "shapes"},
                          {"pass_ms.levels", "levels"},
                          {"pass_ms.balance", "balance"},
                          {"pass_ms.turn", "turn"},
                          {"pass_ms.emit", "emit"},
                          {"pass_ms.all", "all"}}) +
           figures.table("More and fewer cells over the same tiles", "cell_pixel_error_px",
                         {{"cell_pixel_error_px", "pixel error"},
                          {"triangles", "K triangles", 1e3},
                          {"fps_mean", "fps"},
                          {"own_cpu_ms.mean", "own CPU ms"},
                          {"own_cpu_ms.render", "render"},
                          {"own_cpu_ms.workers", "workers"}});
}

}  // namespace ridgeline::app
