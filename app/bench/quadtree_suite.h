// Suite `quadtree`: who chooses the levels of detail, and what it costs, by the gpu-quadtree paper's Table 1.
//
// The quadtree surface with its levels from the GPU's passes and from the CPU, the mesh and the disc, at one
// pixel error on one path, in turn frame by frame; then the quadtree in the walk's busiest frame with more
// and fewer cells over the same tiles.
//
// Render thread; a GL context must be current.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <string>

#include "ridgeline/app/bench/figures.h"
#include "ridgeline/app/options.h"
#include "ridgeline/base/result.h"
#include "ridgeline/io/store.h"

namespace ridgeline::app {

struct QuadtreeSuiteOptions {
    PathChoice path{PathChoice::Kind::ground, {}};
    std::int64_t frames = 300;  // spread evenly over the path
    glm::ivec2 size_px{1024, 768};
    double pixel_error_px = 1.0;
    CacheSizes caches;  // of each variant
    // Called with units done and units in all.
    std::function<void(std::int64_t done, std::int64_t total)> progress;
};

// Variants PATH/quadtree_gpu, /quadtree_cpu, /mesh and /disc: metrics of summary.json that are a variant's
// own, fps_mean, cpu_percent.process, .render and .own (of one core, over the variant's own frames),
// gpu_percent (the GPU's time over the frame's), own_cpu_ms.render, .workers and .mean (own_cpu.h),
// own_cpu_ratio (to quadtree_cpu), fps_ratio (to mesh); quadtree_gpu besides: pass_ms.PASS
// (render/quadtree_pass_clock.h), of all of them pass_ms.all.
//
// Variants still/gpu-F and still/cpu-F, with F times the pixel error for cells alone:
// cell_pixel_error_px, triangles, fps_mean, own_cpu_ms.render, .workers and .mean.
Result<Figures> run_quadtree_suite(const io::Store& store, const QuadtreeSuiteOptions& options);

// The figures as the paper's Table 1 has them, and what cells cost.
std::string quadtree_tables(const Figures& figures);

}  // namespace ridgeline::app
