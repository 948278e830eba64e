// Source pictures as the builder sees them: one north-up lattice of colours in the terrain's CRS, clipped to
// the terrain, whatever GDAL found on the disk. Palettes, greys, 16 bits, CMYK, alpha, nodata, mosaics and
// warping end here; the builder streams rows from north to south.
//
// The lattice is that of the finest picture, the first of several as fine; what lies on it is never
// resampled. Thread rules and messages: as DemSource.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "ridgeline/base/result.h"
#include "ridgeline/base/units.h"

namespace ridgeline::raster {

// The terrain that the pictures lie on.
struct TerrainPlace {
    std::string crs_wkt;  // empty: none, then the pictures' coordinates are taken as they are
    // Its outermost samples' centres.
    double west_m = 0.0, south_m = 0.0, east_m = 0.0, north_m = 0.0;
    double spacing_x_m = 1.0, spacing_y_m = 1.0;
};

struct ImageOptions {
    std::uint64_t cache_bytes = 128_MiB;  // GDAL's block cache, shared by everything that is open
    int threads = 1;                      // for decoding and warping
};

struct ImageSourceInfo {
    std::int64_t width = 0, height = 0;  // texels
    double spacing_x_m = 1.0, spacing_y_m = 1.0;
    // The outer corner of texel (0, 0), the north-western one.
    double west_m = 0.0, north_m = 0.0;
    std::vector<std::string> notes;  // what the user should know, one line each
};

class ImageSource {
  public:
    // Opens one picture, or several of which later ones cover earlier ones. Fails on what has no colours that
    // could be told, on what has no place, and where no picture touches the terrain.
    static Result<ImageSource> open(const std::vector<std::string>& paths, const TerrainPlace& terrain,
                                    const ImageOptions& options = {});

    ImageSource(ImageSource&&) noexcept;
    ImageSource& operator=(ImageSource&&) noexcept;
    ~ImageSource();

    const ImageSourceInfo& info() const;

    // Rows [row, row + rows) at full width, northmost first, as ImageGrid has them.
    Result<void> read_rows(std::int64_t row, std::int64_t rows, std::span<std::uint8_t> rgba);

  private:
    struct State;
    explicit ImageSource(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace ridgeline::raster
