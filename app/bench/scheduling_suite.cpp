#include "ridgeline/app/bench/scheduling_suite.h"

#include "ridgeline/app/bench/scheduling_walk.h"
#include "ridgeline/app/walk/course.h"

namespace ridgeline::app {

Result<SchedulingReport> run_scheduling_suite(const io::Store& store, const SchedulingSuiteOptions& options) {
    if (!store.info().imagery)
        return Error{store.directory().string() +
                     ": holds no imagery, which this suite is about: add some with build --imagery"};
    std::vector<BenchWalk> walks;
    for (const PathChoice& path : options.paths) {
        auto course = resolve_course(store, path, 1.0);
        if (!course) return course.error();
        walks.push_back({path_name(path),
                         std::move(*course),
                         options.frames,
                         options.pixel_error_px,
                         {.size_px = options.size_px},
                         options.caches});
    }
    const std::int64_t total = static_cast<std::int64_t>(walks.size()) * options.frames;
    std::int64_t done = 0;
    const auto step = [&] {
        if (options.progress) options.progress(++done, total);
    };
    SchedulingReport report{{}, scheduling_csv_header()};
    jobs::JobSystem jobs;
    for (const BenchWalk& walk : walks)
        RIDGELINE_TRY(walk_scheduling(store, jobs, walk, report.figures, report.csv, step));
    return report;
}

std::string scheduling_table(const Figures& figures) {
    return figures.table("Sent to the GPU and drawn (the paper's Table 1); ratios to the clipmap",
                         "bytes_per_frame",
                         {{"bytes_per_frame", "KB a frame", 1e3},
                          {"imagery_bytes_per_frame", "imagery KB", 1e3},
                          {"heights_bytes_per_frame", "heights KB", 1e3},
                          {"bytes_per_m", "KB a metre", 1e3},
                          {"start_bytes", "MB before", 1e6},
                          {"bytes_ratio", "ratio"},
                          {"imagery_bytes_ratio", "imagery ratio"},
                          {"heights_bytes_ratio", "heights ratio"},
                          {"bytes_ratio_with_start", "with start"},
                          {"fps_mean", "fps"},
                          {"frame_ms.p99", "p99 ms"},
                          {"cpu_percent.process", "CPU %"},
                          {"cpu_percent.render", "render %"},
                          {"per_frame.imagery_missing", "missing"}});
}

}  // namespace ridgeline::app
