// A source DEM as the builder sees it: one regular north-up grid of heights in metres on a metric plane,
// whatever GDAL found on the disk. Mosaics, south-up files, units, scales, nodata and warping end here; the
// builder streams rows from north to south.
//
// Thread rules: a DemSource is used by one thread at a time and may move between threads. GDAL's own decoding
// and warping threads stay inside. What GDAL has to say becomes part of the returned Error, never output on
// stderr. Ownership: a DemSource owns its open files; they close with it.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ridgeline/base/result.h"
#include "ridgeline/base/units.h"

namespace ridgeline::raster {

struct RasterOptions {
    std::string crs = {};  // the CRS to build in, as GDAL understands it; empty: keep or choose one
    std::optional<double> nodata = {};    // stands in for the files' own nodata value (in stored units)
    std::uint64_t cache_bytes = 128_MiB;  // GDAL's block cache, shared by everything that is open
    int threads = 1;                      // for decoding and warping
};

// Heights beyond this are no terrain of any planet: they are read as nodata, and counted.
constexpr double kMaxHeight_m = 1e6;

// Marks nodata among the integers of read_steps; read_rows marks it with NaN.
constexpr std::int32_t kNoStep = std::numeric_limits<std::int32_t>::min();

struct RasterInfo {
    // Samples, at least 2 in either direction: a single row or column stands doubled, one spacing on.
    std::int64_t width = 0;
    std::int64_t height = 0;
    double spacing_x_m = 1.0;
    double spacing_y_m = 1.0;
    // The centre of sample (column 0, row 0) in crs_wkt; row 0 is the northmost, row r lies r * spacing_y_m
    // south.
    double west_east_m = 0.0;
    double north_north_m = 0.0;
    std::string crs_wkt;  // projected, in metres, read as (east, north); empty where the files name none
    bool georeferenced = false;    // without: one unit a pixel, east = column, north = height - 1 - row
    bool warped = false;           // resampled, bilinear
    bool integer_heights = false;  // every height is exactly offset_m + k * step_m: read_steps gives k
    double step_m = 1.0;           // positive; of integer heights
    double offset_m = 0.0;         // of integer heights
    bool may_have_nodata = false;  // false promises that every sample is a height
    // Rows that come at once from the disk, up to all of them: read multiples of it where memory allows.
    std::int64_t natural_rows = 1;
    std::vector<std::string> sources;  // the paths, as given
    std::string driver;                // GDAL's short name, of the first source
    std::string data_type;             // likewise: "Int16", "Float32", …
    std::vector<std::string> notes;    // what the user should know, one line each
};

// What reading has met so far. A sample that is read twice counts twice.
struct ReadCounts {
    std::uint64_t samples = 0;
    std::uint64_t nodata = 0;        // all samples without a height, those below included
    std::uint64_t not_finite = 0;    // NaN (undeclared) or infinite
    std::uint64_t out_of_range = 0;  // beyond kMaxHeight_m
    std::uint64_t suspect = 0;       // heights that equal a customary nodata value (-9999, -32767, -32768)
};

class DemSource {
  public:
    // Opens one raster, or several as a mosaic in which later ones cover earlier ones. A path that ends in
    // .zip is read through /vsizip/. Fails on what cannot be heights (complex numbers, no bands), on declared
    // sizes whose blocks do not exist, and on a --crs that is not projected.
    static Result<DemSource> open(const std::vector<std::string>& paths, const RasterOptions& options = {});

    DemSource(DemSource&&) noexcept;
    DemSource& operator=(DemSource&&) noexcept;
    ~DemSource();

    const RasterInfo& info() const;

    // Rows [row, row + rows) at full width, northmost first; heights_m holds rows * width values, NaN is
    // nodata. A file that cannot be read to its end is an Error that names it.
    Result<void> read_rows(std::int64_t row, std::int64_t rows, std::span<double> heights_m);

    // The same as integers k, of which the height is offset_m + k * step_m, or kNoStep. Only where
    // info().integer_heights.
    Result<void> read_steps(std::int64_t row, std::int64_t rows, std::span<std::int32_t> steps);

    const ReadCounts& counts() const;

    // What reading has found that the user should know, one line each ("12 samples are not finite: …").
    std::vector<std::string> findings() const;

  private:
    struct State;
    explicit DemSource(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace ridgeline::raster
