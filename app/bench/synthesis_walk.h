// Down from 5 km to half a metre and along the ground, over the full source, over one with every eighth of its samples,
// and over what is made below that; the variants take turns frame by frame.
//
// Render thread, with a GL context current.
#pragma once

#include <functional>
#include <string>

#include "ridgeline/app/bench/descent.h"
#include "ridgeline/app/bench/figures.h"
#include "ridgeline/app/bench/walk_lane.h"
#include "ridgeline/base/result.h"
#include "ridgeline/io/store.h"
#include "ridgeline/jobs/job_system.h"

namespace ridgeline::app {

// What the walks share. Stores of the same ground; octaves: that bring the decimated one to the other's spacing.
struct SynthesisBench {
    const io::Store& real;
    const io::Store& decimated;
    int octaves;
    jobs::JobSystem& jobs;
    const BenchWalk& walk;
    // Called after each frame of all variants.
    std::function<void()> step;
};

// The first row of a CSV, which names columns.
std::string synthesis_csv_header();
// With one surface: figures under SURFACE/VARIANT (synthesis_suite.h), a row a frame appended to the CSV.
Result<void> walk_down(const SynthesisBench& bench, render::Surface surface, Figures& figures,
                       std::string& csv);

}  // namespace ridgeline::app
