// Walks with the quadtree's levels from the GPU and from the CPU, and with the other surfaces, in turn frame
// by frame; and stands still while the quadtree's cells become more and fewer.
//
// Render thread, with a GL context current.
#pragma once

#include <functional>

#include "ridgeline/app/bench/figures.h"
#include "ridgeline/app/bench/own_cpu.h"
#include "ridgeline/app/bench/walk_lane.h"
#include "ridgeline/base/result.h"
#include "ridgeline/io/store.h"
#include "ridgeline/jobs/job_system.h"

namespace ridgeline::app {

// What the walks share. jobs: whose workers `cpu` knows.
struct QuadtreeBench {
    const io::Store& store;
    jobs::JobSystem& jobs;
    OwnCpu& cpu;
    const BenchWalk& walk;
    // Called after each frame of all variants.
    std::function<void()> step;
};

// Figures under walk.name/VARIANT (quadtree_suite.h). Returns the frame in which the quadtree had the most
// cells.
Result<std::int64_t> walk_surfaces(const QuadtreeBench& bench, Figures& figures);

// Frames of stand_still() in all.
std::int64_t still_frames(const BenchWalk& walk);
// In one frame of the walk; figures under still/VARIANT.
Result<void> stand_still(const QuadtreeBench& bench, std::int64_t frame, Figures& figures);

}  // namespace ridgeline::app
