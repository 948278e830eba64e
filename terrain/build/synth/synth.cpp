#include "ridgeline/synth/synth.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

#include "geotiff_file.h"
#include "ground_colours.h"
#include "ridgeline/jobs/job_system.h"
#include "terrain.h"

namespace ridgeline::synth {
namespace {

constexpr int kTile = 256;

bool stopped(const SynthOptions& options) { return options.stop != nullptr && options.stop->load(); }

Result<void> require_sense(const SynthOptions& options) {
    if (options.size < 2 || options.size > std::numeric_limits<std::int32_t>::max() / 2)
        return Error{"a size of " + std::to_string(options.size) +
                     " samples cannot be made: at least 2 are needed"};
    if (!(options.spacing_m > 0.0 && options.spacing_m < 1e6))
        return Error{"a spacing of " + std::to_string(options.spacing_m) + " m makes no sense"};
    if (options.imagery_path.empty()) return {};
    if (options.imagery_ratio < 1 || GroundColours::side(options.size, options.imagery_ratio) >
                                         std::numeric_limits<std::int32_t>::max() / 2)
        return Error{"a picture of " + std::to_string(options.imagery_ratio) +
                     " texels a sample cannot be made of so many samples"};
    if (options.imagery_path == options.path)
        return Error{options.path + ": heights and imagery cannot be the same file"};
    return {};
}

// Rows of `side` items in bands, each filled in parallel and written: fill(area, items), write(row, rows,
// items).
struct Bands {
    int side = 0;
    std::size_t values = 1;  // an item
};
template <class T, class Fill, class Write>
Result<void> write_bands(const Bands& bands, jobs::JobSystem& jobs, Fill&& fill, Write&& write) {
    std::vector<T> band;
    const std::size_t row_values = static_cast<std::size_t>(bands.side) * bands.values;
    for (int row = 0; row < bands.side; row += kTile) {
        const int rows = std::min(kTile, bands.side - row);
        band.resize(row_values * static_cast<std::size_t>(rows));
        jobs.parallel_for(0, (bands.side + kTile - 1) / kTile, 1, [&](std::int64_t tile) {
            const int column = static_cast<int>(tile) * kTile;
            const SampleArea area{column, row, std::min(kTile, bands.side - column), rows};
            const std::size_t part = static_cast<std::size_t>(area.columns) * bands.values;
            std::vector<T> items(part * static_cast<std::size_t>(rows));
            fill(area, std::span<T>(items));
            for (std::size_t j = 0; j < static_cast<std::size_t>(rows); ++j)
                std::copy_n(&items[j * part], part,
                            &band[j * row_values + static_cast<std::size_t>(column) * bands.values]);
        });
        RIDGELINE_TRY(write(row, rows, std::span<const T>(band)));
    }
    return {};
}

int texels_of(const SynthOptions& options) {
    return options.imagery_path.empty()
               ? 0
               : static_cast<int>(GroundColours::side(options.size, options.imagery_ratio));
}

// One run: what both files are made of.
class Synthesis {
  public:
    Synthesis(const SynthOptions& options, jobs::JobSystem& jobs, const Progress& progress)
        : options_(options),
          jobs_(jobs),
          progress_(progress),
          size_(static_cast<int>(options.size)),
          texels_(texels_of(options)),
          shape_{size_, static_cast<float>(options.spacing_m), options.seed},
          terrain_(shape_) {}

    Result<void> make_heights(GeoTiffFile& file) const {
        return write_bands<float>(
            {size_, 1}, jobs_,
            [&](const SampleArea& area, std::span<float> out) { terrain_.fill(area, out); },
            [&](int row, int rows, std::span<const float> band) {
                const auto written = file.write_rows(row, rows, band);
                return written ? step(options_.path, row + rows) : written;
            });
    }
    Result<void> make_colours(GeoTiffFile& file) const {
        const GroundColours ground(terrain_, shape_, options_.imagery_ratio);
        return write_bands<std::uint8_t>(
            {texels_, kColourBytes}, jobs_,
            [&](const SampleArea& area, std::span<std::uint8_t> out) { ground.fill(area, out); },
            [&](int row, int rows, std::span<const std::uint8_t> band) {
                const auto written = file.write_rows(row, rows, band);
                return written ? step(options_.imagery_path, size_ + row + rows) : written;
            });
    }

  private:
    Result<void> step(const std::string& path, int rows_done) const {
        if (progress_) progress_(rows_done, size_ + texels_);
        return stopped(options_) ? Result<void>(Error{path + ": stopped before it was complete"})
                                 : Result<void>();
    }

    const SynthOptions& options_;
    jobs::JobSystem& jobs_;
    const Progress& progress_;
    int size_;
    int texels_;
    TerrainOptions shape_;
    Terrain terrain_;
};

}  // namespace

Result<void> synth(const SynthOptions& options, jobs::JobSystem& jobs, const Progress& progress) {
    RIDGELINE_TRY(require_sense(options));
    auto heights = GeoTiffFile::create(
        options.path, options.replace,
        {Samples::heights, static_cast<int>(options.size), options.spacing_m, kTile, jobs.worker_count()});
    if (!heights) return heights.error();
    if (options.imagery_path.empty()) {
        RIDGELINE_TRY(Synthesis(options, jobs, progress).make_heights(*heights));
        return heights->finish();
    }
    auto colours =
        GeoTiffFile::create(options.imagery_path, options.replace,
                            {Samples::colours, texels_of(options), options.spacing_m / options.imagery_ratio,
                             kTile, jobs.worker_count()});
    if (!colours) return colours.error();
    const Synthesis synthesis(options, jobs, progress);
    RIDGELINE_TRY(synthesis.make_heights(*heights));
    RIDGELINE_TRY(synthesis.make_colours(*colours));
    RIDGELINE_TRY(colours->finish());
    return heights->finish();
}

}  // namespace ridgeline::synth
