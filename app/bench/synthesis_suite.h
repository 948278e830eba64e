// Suite `synthesis`: what made ground costs and how like the real one it is, by the synthesis paper's Fig. 7.
//
// Every eighth sample of the store's finest heights becomes a store of its own. A descent (descent.h) over the full source,
// over that store, and over what is made below it, for the disc and the quadtree; tiles made a second by the GPU and by
// the CPU; and at the lags that decimation lost, how rough the made ground is beside the real one, with pictures.
//
// Render thread; a GL context must be current.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <string>

#include "ridgeline/app/bench/figures.h"
#include "ridgeline/app/bench/synthesis_pictures.h"
#include "ridgeline/app/bench/tile_making.h"
#include "ridgeline/app/options.h"
#include "ridgeline/base/result.h"
#include "ridgeline/io/store.h"

namespace ridgeline::app {

struct SynthesisSuiteOptions {
    // Its places and headings: the descent is over the first one.
    PathChoice path{PathChoice::Kind::ground, {}};
    std::int64_t frames = 300;  // of each surface's descent, spread evenly over it
    glm::ivec2 size_px{1024, 768};
    double pixel_error_px = 1.0;
    CacheSizes caches;  // of each variant
    TileMakingOptions making;
    int blocks = 300;  // of samples, whose roughness is compared
    // Its start is the path's.
    SynthesisPictureOptions pictures;
    // Called with units done and units in all.
    std::function<void(std::int64_t done, std::int64_t total)> progress;
};

// Variants SURFACE/real, /decimated, /made (at the real spacing), /deep (as many octaves as foretold), of disc and quadtree:
// metrics of summary.json that are a variant's own; spacing_m (of the finest ground), fps_mean, fps_ratio (to real),
// us_per_triangle (of a frame's time), bytes_read and bytes_uploaded (the start's in). Of made and deep besides:
// us_per_triangle_ratio (to decimated), us_per_triangle_to_real, tiles_made.mean and .max (a frame), make_ms.mean,
// make_percent.all and .max (of the frames' time together, of one frame's at most).
//
// tiles/gpu, tiles/cpu, tiles/cpu_one_core: tile_making.h. roughness/decimated, roughness/made: lag1, lag2, lag4, mean
// squared differences over the real ground's. store/real, store/decimated: heights_bytes, mesh_bytes.
struct SynthesisReport {
    Figures figures;
    // A row a frame of each surface; the first names columns.
    std::string csv;
};
// Fails for a store whose eighth part is too small to foretell anything.
Result<SynthesisReport> run_synthesis_suite(const io::Store& store, const SynthesisSuiteOptions& options);

std::string synthesis_tables(const Figures& figures);

}  // namespace ridgeline::app
