// Suite `horizon`: what leaving out hidden ground saves, by the horizon paper's measures (Tables 2 and 3),
// and how much of what is truly hidden each variant finds.
//
// `off`, `boxes` and `ridges` walk the same paths frame by frame in turn, so that whatever else the machine
// does meets all of them alike. Random level views at several heights are held against an exact oracle
// (visibility_oracle.h). Render thread; a GL context must be current.
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

struct HorizonSuiteOptions {
    // Walked as it is, and once more looking about.
    PathChoice path{.kind = PathChoice::Kind::ground, .file = {}};
    std::int64_t frames = 300;  // of each walk, spread evenly over the path
    glm::ivec2 size_px{1024, 768};
    double pixel_error_px = 1.0;
    CacheSizes caches;  // of each variant of a walk
    // The path is also walked at the pixel error at which `off` draws as many triangles as this.
    double dense_triangles = 1.5e6;
    int views = 120;  // random ones at each height
    std::uint64_t seed = 1;
    // Called with units done and units in all.
    std::function<void(std::int64_t done, std::int64_t total)> progress;
};

// Variants PATH/off, PATH/boxes, PATH/ridges.
//
// Walks (the path's name, `look`, `dense`): metrics of summary.json that are a variant's own; fps_mean,
// fps_ratio (over off's), fps_ratio_to_boxes, triangles_ratio (off's over it), tiles_in, tiles_out,
// tiles_ratio (in, over off's), bytes_read, frames, pixel_error_px. `dense` is left out where no pixel error
// draws so many triangles.
//
// Views (2m, 30m, 200m, 1000m over the ground), per view where no share: per_frame.nodes_drawn,
// per_frame.triangles, selection_ms.mean and .p99 (CPU time, one thread), triangles_ratio;
// oracle_hidden_share, the culled share of the drawn nodes that the oracle calls hidden; wrongly_culled, the
// nodes of which a seen part was left out, over all views; of the oracle nodes_visible, nodes_hidden,
// nodes_unknown and oracle_triangles_ratio, beyond which no culling by quarters of nodes can get.
Result<Figures> run_horizon_suite(const io::Store& store, const HorizonSuiteOptions& options);

// The figures as the paper's tables have them, and one of the views.
std::string horizon_tables(const Figures& figures);
// Over all views.
std::int64_t wrongly_culled(const Figures& figures);

}  // namespace ridgeline::app
