// One path, walked by turns with each variant of suite `scheduling`, the clipmaps beside them.
//
// Render thread, with a GL context current.
#pragma once

#include <functional>
#include <string>

#include "ridgeline/app/bench/figures.h"
#include "ridgeline/app/bench/walk_lane.h"
#include "ridgeline/base/result.h"
#include "ridgeline/io/store.h"

namespace ridgeline::app {

// The first line of the curves, line end included.
std::string scheduling_csv_header();

// Figures under walk.name/VARIANT, and a line a frame behind `csv` (scheduling_suite.h). `step` is called
// after each frame of all variants.
Result<void> walk_scheduling(const io::Store& store, jobs::JobSystem& jobs, const BenchWalk& walk,
                             Figures& figures, std::string& csv, const std::function<void()>& step);

}  // namespace ridgeline::app
