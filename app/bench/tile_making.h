// How many tiles of made ground a second: by the GPU's pass, and by the CPU on all cores, the same tiles in turn; and
// whether both make the same.
//
// Render thread, with a GL context current.
#pragma once

#include "ridgeline/app/bench/figures.h"
#include "ridgeline/base/result.h"
#include "ridgeline/io/store.h"
#include "ridgeline/jobs/job_system.h"

namespace ridgeline::app {

struct TileMakingOptions {
    int parents = 64;      // of the store's finest tiles, from all over it; four children of each
    double seconds = 3.0;  // of each variant, about
};

// Figures under tiles/gpu, /cpu and /cpu_one_core: tiles_per_s, per_second_ratio (to cpu), bytes_sent_per_tile (what the
// GPU still has to be sent). Fails where a sample differs.
Result<void> make_tiles(const io::Store& store, jobs::JobSystem& jobs, const TileMakingOptions& options,
                        Figures& figures);

}  // namespace ridgeline::app
