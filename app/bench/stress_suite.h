// Suite `stress`: journeys that no walk asks for, small and large caches, slow and failing disks, and what
// must hold all the same.
//
// Journeys: teleports, turns, sprint, dives (stress_paths.h), or the path that is asked for; each by every
// variant of stress_variants.h beside a twin without faults (stress_walk.h). Then a sudden turn by every
// variant (stress_turn.h). And, where there is another store of the same ground, its frames beside this
// one's.
//
// Render thread; a GL context must be current.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "ridgeline/app/bench/figures.h"
#include "ridgeline/app/options.h"
#include "ridgeline/base/result.h"
#include "ridgeline/io/store.h"

namespace ridgeline::app {

struct StressSuiteOptions {
    std::optional<PathChoice> path;     // instead of the suite's own
    std::vector<std::string> variants;  // names of stress_variants.h; none: all
    std::int64_t frames = 300;          // of each journey, spread evenly over it
    int turns = 4;                      // sudden ones by each variant, from places spread over the journey
    glm::ivec2 size_px{1024, 768};
    double pixel_error_px = 1.0;
    CacheSizes caches;  // of variants that say nothing of them
    // Another store, over the same ground and more of it. May be null; must outlive the suite.
    const io::Store* beside = nullptr;
    // Called with units done and units in all.
    std::function<void(std::int64_t done, std::int64_t total)> progress;
};

// Variants PATH/VARIANT:
//   frames, frame_ms.*, selection_ms.*, gpu_ms.*, request_to_ready_ms.*, request_to_drawn_frames.*, tiles.*,
//   frames_with_missing_*, ram_cache_bytes_max, gpu_cache_bytes_max   as in summary.json
//   frame_ms.{mean,p50,p99}_ratio, selection_ms.{mean,p50}_ratio      to the twin
//   background_pixels           of all frames, where ground should be
//   bytes_over_budget           of both caches, the most in any frame
//   eye_lift.frames, eye_lift_m.max
//   failures.repeated, .given_up   reads that were repeated at once; tiles that failed all the same
//   failures.left, rest.missing    wanted tiles not there at the end, beyond the twin's; in all
//   rest.differing_pixels          at the end, from the twin's picture; without it where caches differ
// turn/VARIANT:
//   turn_sharp_ms, turn_there_ms   from the turn to nothing missing in the picture, and to all that is wanted
//   turn_floor_ms, turn_floor_ratio  bytes ÷ the disk's rate + the injected delays + 2 frames
//   turn_frames, turn_bytes, turn_missing; each .mean and .max
// PATH/beside: the other store's frames, its twin on this one. disk/warm: bytes_per_s.
Result<Figures> run_stress_suite(const io::Store& store, const StressSuiteOptions& options);

std::string stress_tables(const Figures& figures);

// What must be nothing: background, bytes over budget, tiles still missing after the faults, pixels that
// differ then. An error names the first variant where it is not.
Result<void> stress_verdict(const Figures& figures);

}  // namespace ridgeline::app
