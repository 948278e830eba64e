// Suite `metric`: what the constrained normal cone does for the picture, beside the vertical error alone.
//
// Two stores of the same ground, one a metric, are held against the source: every level's surface, and what
// is drawn from random places. Levels have about equally many triangles under both metrics, because their
// thresholds come from the same budget; what is drawn is compared at the same pixel error and, for the cone,
// also at the pixel error that gives as many triangles as the geometric store's.
//
// Where pictures are asked for, a few telling views are also drawn, both variants side by side.
//
// Holds two fields of the raster in memory (SurfaceField). One thread at a time, with pictures the render
// thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "ridgeline/app/bench/figures.h"
#include "ridgeline/app/bench/metric_pictures.h"
#include "ridgeline/base/result.h"
#include "ridgeline/io/store.h"

namespace ridgeline::app {

struct MetricSuiteOptions {
    int eyes = 48;      // random places
    int columns = 256;  // of each skyline, all round
    double pixel_error_px = 1.0;
    // Pictures metric-1.png, -2.png, ... are drawn as well; a GL context must be current then.
    std::optional<MetricPictureOptions> pictures;
    // Called with units done and units in all.
    std::function<void(std::int64_t done, std::int64_t total)> progress;
};

// Variants levelL/METRIC and drawn/METRIC. Metrics: triangles (of drawn variants: a view's, a quarter of what
// lies all round), pixel_error_px, height_m.mean and .max, normal_degrees.mean, skyline_px.mean and .p99. A
// level's skyline is that of the ground beyond the distance at which its geometric nodes show one pixel of
// error, on average; it is left out where no ground lies so far. Pictures add metric-N/METRIC
// (metric_pictures.h).
Result<Figures> compare_metrics(const io::Store& geometric, const io::Store& cone,
                                const MetricSuiteOptions& options);

// Builds both stores in a temporary folder, from the rasters in sources or, where there are none, from the
// heights of the store at `directory`, and compares them.
struct MetricSuiteInputs {
    std::filesystem::path directory;
    std::vector<std::string> sources;
};
Result<Figures> run_metric_suite(const MetricSuiteInputs& inputs, const MetricSuiteOptions& options);

}  // namespace ridgeline::app
