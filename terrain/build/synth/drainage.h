// The lie of the land: ranges, foothills and plains, cut by valleys that drain.
//
// A fixed number of nodes whatever the raster's size; solved on one thread, so it is the same everywhere.
#pragma once

#include <cstdint>

#include "height_map.h"

namespace ridgeline::synth {

struct DrainageOptions {
    float extent_m = 100e3f;
    float relief_m = 3500.0f;  // height of the highest summits
    float finest_cell_m =
        100.0f;  // reached within a factor of 2, as far as the greatest number of nodes allows
    std::uint32_t seed = 1;
};

// The map covers [0, extent_m]². Its rim is where rivers leave: crop it.
HeightMap drained_landscape(const DrainageOptions& options);

}  // namespace ridgeline::synth
