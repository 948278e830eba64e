// One journey of suite `stress` by one variant, beside a twin without faults that takes turns with it frame
// by frame: so that what is slower is slower than its own twin in the same second, and what is drawn in the
// end can be held to what should be.
//
// Every picture of the variant is looked at for holes, between the frames and outside their time. Faults end
// with the journey; the last view is then shown until all that it wants is there, and both pictures are
// compared. Render thread; a GL context must be current.
#pragma once

#include <functional>
#include <string>

#include "ridgeline/app/bench/figures.h"
#include "ridgeline/app/bench/stress_variants.h"
#include "ridgeline/app/bench/walk_lane.h"
#include "ridgeline/base/result.h"
#include "ridgeline/io/store.h"
#include "ridgeline/jobs/job_system.h"

namespace ridgeline::app {

struct StressGround {
    const io::Store& store;
    jobs::JobSystem& jobs;
};

// walk.caches are the twin's. `on`: where the variant walks, of the same CRS; the twin walks on `ground`.
struct StressPair {
    const StressGround& ground;
    const io::Store& on;
    const BenchWalk& walk;
    StressVariant variant;
};

// Sets the metrics that stress_suite.h lists. step: called after each frame.
Result<void> walk_stressed(const StressPair& pair, Figures& figures, const std::function<void()>& step);

}  // namespace ridgeline::app
