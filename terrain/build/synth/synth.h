// Made-up mountains of any size as a GeoTIFF, and what they look like from above as another, for trying
// things out where no DEM is at hand.
//
// Heights are a pure function of position and seed, so a file is the same, byte for byte, on any number of
// workers, and is written in bands of rows: memory does not grow with the raster's height. Thread rules:
// synth() computes on the jobs it is given and writes from the calling thread.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>

#include "ridgeline/base/result.h"

namespace ridgeline::jobs {
class JobSystem;
}

namespace ridgeline::synth {

// Whether a file that stands at the path gives way. What is no file (a directory, a link) never does.
enum class Replace { never, existing };

struct SynthOptions {
    std::int64_t size = 8193;  // samples along either side, at least 2
    double spacing_m = 10.0;
    std::uint64_t seed = 1;
    std::string path = {};          // of the GeoTIFF; replaced only when the new one is complete
    std::string imagery_path = {};  // of a GeoTIFF of colours over the same ground; empty: none
    int imagery_ratio = 3;          // its texels a sample
    Replace replace = Replace::never;
    const std::atomic<bool>* stop = nullptr;  // raised by whoever wants synth() to end early, with an Error
};

// Called from the calling thread of synth() with rows done and rows in all, of both files together.
using Progress = std::function<void(std::int64_t rows_done, std::int64_t rows)>;

// Writes tiled GeoTIFFs in UTM zone 33N (EPSG:32633), centred on the zone's meridian at 47° north. On failure
// nothing is left at or beside their places that was not there before.
Result<void> synth(const SynthOptions& options, jobs::JobSystem& jobs, const Progress& progress = {});

}  // namespace ridgeline::synth
