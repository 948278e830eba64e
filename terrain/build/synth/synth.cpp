#include "ridgeline/synth/synth.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "geotiff_file.h"
#include "ridgeline/jobs/job_system.h"
#include "terrain.h"

namespace ridgeline::synth {
namespace {

constexpr int kTile = 256;

bool stopped(const SynthOptions& options) { return options.stop != nullptr && options.stop->load(); }

// Fills a full-width band of at most kTile rows, tile by tile in parallel.
void fill_band(const Terrain& terrain, jobs::JobSystem& jobs, int size, int row, int rows,
               std::span<float> band) {
    jobs.parallel_for(0, (size + kTile - 1) / kTile, 1, [&](std::int64_t tile) {
        const int column = static_cast<int>(tile) * kTile;
        const SampleArea area{column, row, std::min(kTile, size - column), rows};
        std::vector<float> heights_m(static_cast<std::size_t>(area.columns) * static_cast<std::size_t>(rows));
        terrain.fill(area, heights_m);
        for (int j = 0; j < rows; ++j)
            std::copy_n(heights_m.begin() + std::ptrdiff_t{j} * area.columns, area.columns,
                        band.begin() + std::ptrdiff_t{j} * size + column);
    });
}

Result<void> require_sense(const SynthOptions& options) {
    if (options.size < 2 || options.size > std::numeric_limits<std::int32_t>::max() / 2)
        return Error{"a size of " + std::to_string(options.size) +
                     " samples cannot be made: at least 2 are needed"};
    if (!(options.spacing_m > 0.0 && options.spacing_m < 1e6))
        return Error{"a spacing of " + std::to_string(options.spacing_m) + " m makes no sense"};
    return {};
}

}  // namespace

Result<void> synth(const SynthOptions& options, jobs::JobSystem& jobs, const Progress& progress) {
    RIDGELINE_TRY(require_sense(options));
    const int size = static_cast<int>(options.size);
    auto file = GeoTiffFile::create(options.path, options.replace,
                                    {size, options.spacing_m, kTile, jobs.worker_count()});
    if (!file) return file.error();
    const Terrain terrain({size, static_cast<float>(options.spacing_m), options.seed});
    std::vector<float> band;
    for (int row = 0; row < size; row += kTile) {
        if (stopped(options)) return Error{options.path + ": stopped before it was complete"};
        const int rows = std::min(kTile, size - row);
        band.resize(static_cast<std::size_t>(size) * static_cast<std::size_t>(rows));
        fill_band(terrain, jobs, size, row, rows, band);
        RIDGELINE_TRY(file->write_rows(row, rows, band));
        if (progress) progress(row + rows, size);
    }
    return file->finish();
}

}  // namespace ridgeline::synth
