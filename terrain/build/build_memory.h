// What a build takes of memory, told before a row is read.
//
// Most of the raster lies on disk; what is held of all of it is a 64th of its samples, a record a node and
// counts a block. That grows with the raster, so a build is told how much it may take, and is refused where
// that cannot be enough. Thread rules: pure functions, any thread.
#pragma once

#include <cstdint>

#include "ridgeline/base/result.h"
#include "ridgeline/io/grid.h"

namespace ridgeline::build {

// What a build's memory depends on.
struct BuildShape {
    io::Grid grid;
    bool may_have_nodata = true;    // then there may be a fill to hold
    std::int64_t natural_rows = 1;  // that come from the source at once
};

// Rows are read in bands of some MiB, of whole natural rows where those are not far more.
std::int64_t band_rows(const BuildShape& shape);
// GDAL's cache of blocks: a quarter of what there is, within what reading can use.
std::uint64_t raster_cache_bytes(std::uint64_t memory_bytes);
// The least with which a build runs: on two threads, which is the fewest. In whole MiB.
std::uint64_t least_memory_bytes(const BuildShape& shape);
// How many threads there is memory for. The error names the least that does.
Result<int> affordable_threads(const BuildShape& shape, std::uint64_t memory_bytes);

}  // namespace ridgeline::build
