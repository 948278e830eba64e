// Where the builder's heights come from: rows of integers in the store's quantum, north to south.
//
// Thread rules: one thread at a time.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ridgeline/base/result.h"
#include "ridgeline/base/units.h"
#include "ridgeline/build/samples.h"
#include "ridgeline/io/terrain_info.h"

namespace ridgeline::build {

class HeightRows {
  public:
    virtual ~HeightRows() = default;

    // Frame, size, quantum, offset and provenance; what building finds out is still open.
    virtual const io::TerrainInfo& info() const = 0;
    // False promises that every sample is a height.
    virtual bool may_have_nodata() const = 0;
    // Rows that come at once: reading multiples of it is fastest.
    virtual std::int64_t natural_rows() const = 0;
    // Rows [row, row + rows) at full width; kNoHeight where there is none, otherwise within +-kMaxQuanta.
    virtual Result<void> read(std::int64_t row, std::int64_t rows, std::span<std::int32_t> quanta) = 0;
    // What the user should know of the samples read, one line each.
    virtual std::vector<std::string> findings() const = 0;
};

struct DemOptions {
    std::vector<std::string> sources;
    std::string crs;
    std::optional<double> nodata;
    std::uint64_t cache_bytes = 128_MiB;
    int threads = 1;
};

// Rows of the rasters that GDAL reads. Integer sources that are not resampled keep their own step as quantum;
// others get 1/32 m, or finer where samples lie closer than two metres.
Result<std::unique_ptr<HeightRows>> open_dem(const DemOptions& options);

}  // namespace ridgeline::build
