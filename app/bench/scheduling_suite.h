// Suite `scheduling`: what is sent to the GPU on a walk with imagery, how fast it is and how busy the CPU, by
// the scheduling paper's Table 1 and its Fig. 10.
//
// Our walk with and without the horizon, a clipmap of the same texel density and formats over the same path
// (scheduling_clipmaps.h), that clipmap with imagery in plain RGB8 and with heights of 16 bits, and plain
// uploading of all that is seen (cpu_lod.h). Those that are drawn take turns frame by frame. Bytes are tiles
// and page tables; what a frame needs anyway (uniforms, instances, commands) is no variant's.
//
// Render thread; a GL context must be current.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "ridgeline/app/bench/figures.h"
#include "ridgeline/app/options.h"
#include "ridgeline/base/result.h"
#include "ridgeline/io/store.h"

namespace ridgeline::app {

struct SchedulingSuiteOptions {
    std::vector<PathChoice> paths = {{PathChoice::Kind::ground, {}}, {PathChoice::Kind::orbit, {}}};
    std::int64_t frames = 300;  // of each walk, spread evenly over the path
    glm::ivec2 size_px{1024, 768};
    double pixel_error_px = 1.0;
    CacheSizes caches;  // of each variant
    // Called with units done and units in all.
    std::function<void(std::int64_t done, std::int64_t total)> progress;
};

// Variants PATH/ridges, /off and /cpu_lod, which are drawn, /clipmap, /clipmap_rgb8 and /clipmap_lean, which
// are reckoned.
//
// All: frames, pixel_error_px, bytes_per_frame, imagery_bytes_per_frame, heights_bytes_per_frame (meshes and
// normals, or heights and normals), bytes_per_m (of the way), start_bytes (sent before the first frame, in
// none of the others). Over the clipmap's: bytes_ratio, imagery_bytes_ratio, heights_bytes_ratio,
// bytes_ratio_with_start. Drawn: metrics of summary.json that are a variant's own, fps_mean,
// cpu_percent.process and .render (of one core, over the variant's own frames), per_frame.imagery_missing
// (tiles wanted and not there yet), tiles_in, tiles_out, bytes_read. Reckoned: imagery_window_texels,
// heights_window_texels, of the widest window.
struct SchedulingReport {
    Figures figures;
    // A row a frame, the first names columns: path, frame, bytes of each variant and the imagery's of them,
    // and of those drawn the frame's time and the CPU's use.
    std::string csv;
};
// Fails for a store without imagery.
Result<SchedulingReport> run_scheduling_suite(const io::Store& store, const SchedulingSuiteOptions& options);

// The figures as the paper's Table 1 has them.
std::string scheduling_table(const Figures& figures);

}  // namespace ridgeline::app
