// After a sudden turn by 180 degrees, how long until the view is sharp and until everything that is wanted is
// there, beside the least that the disk allows.
//
// One stage alone, frame after frame as fast as they come, as in a walk. Render thread; a GL context must be
// current.
#pragma once

#include <functional>

#include "ridgeline/app/bench/figures.h"
#include "ridgeline/app/bench/stress_walk.h"

namespace ridgeline::app {

struct StressTurns {
    const BenchWalk& walk;
    int count = 1;  // views, spread over the path, from which it turns
    double disk_bytes_per_s = 1.0;
};

// How fast the store's tiles can be read, in the pieces in which the pager reads them; those that the system
// can hold are in memory from then on.
Result<double> disk_bytes_per_s(const io::Store& store);

// Sets turn/VARIANT: metrics turn_* of stress_suite.h. step: called after each turn.
Result<void> turn_round(const StressGround& ground, const StressTurns& turns, const StressVariant& variant,
                        Figures& figures, const std::function<void()>& step);

}  // namespace ridgeline::app
