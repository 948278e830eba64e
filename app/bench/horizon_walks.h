// Walks with each variant of the horizon in turn, frame by frame, on stages of their own: frame times,
// triangles, tiles paged.
//
// Render thread, with a GL context current.
#pragma once

#include <functional>
#include <optional>

#include "ridgeline/app/bench/figures.h"
#include "ridgeline/app/bench/horizon_variants.h"
#include "ridgeline/app/bench/walk_lane.h"
#include "ridgeline/base/result.h"
#include "ridgeline/io/store.h"
#include "ridgeline/jobs/job_system.h"
#include "ridgeline/platform/path.h"

namespace ridgeline::app {

// Figures under walk.name/VARIANT (horizon_suite.h). `step` is called after each frame of all variants.
Result<void> walk_side_by_side(const io::Store& store, jobs::JobSystem& jobs, const BenchWalk& walk,
                               Figures& figures, const std::function<void()>& step);

// The same places, looking about: to all sides, up and down.
platform::ResolvedPath looking_about(const platform::ResolvedPath& path);

// The pixel error, at most that of the walk, at which its frames draw so many triangles on average with
// nothing left out; none where no pixel error does. Reads nothing.
std::optional<double> pixel_error_for(const io::Store& store, const BenchWalk& walk, double triangles);

}  // namespace ridgeline::app
