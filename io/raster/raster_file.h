// What files of heights and of pictures have in common: how they are found, kept open and read.
#pragma once

#include <gdal_priv.h>

#include <algorithm>
#include <cstdint>
#include <list>
#include <span>
#include <string>

#include "height_grid.h"
#include "placement.h"
#include "ridgeline/base/result.h"

namespace ridgeline::raster {

// A file that can close itself and open again when it is next used.
class ReopenableFile {
  public:
    virtual ~ReopenableFile() = default;
    virtual void close() = 0;
};

// The files that are open, most recently used first: a mosaic may have more files than a process may have
// open. One thread at a time.
class OpenFiles {
  public:
    // Far below the usual limit of 1024 descriptors, far above the files that a row of a mosaic crosses.
    static constexpr std::size_t kMaxOpen = 200;

    void used(ReopenableFile* file);
    void forget(ReopenableFile* file);

  private:
    std::list<ReopenableFile*> files_;
};

// What GDAL is to open for a path as users write it: rasters in .zip and .gz archives too.
Result<std::string> gdal_path(const std::string& path);

// Null where GDAL cannot: what it said is in the caller's GdalMessages.
GDALDatasetUniquePtr open_dataset(const std::string& gdal_path, int threads);

// Fails on declared sizes whose blocks do not exist: a damaged header, or a joke.
Result<void> check_blocks(GDALDataset& dataset, const std::string& gdal_path);

// Where GDAL gives no reason: what its decoding threads say of a damaged block reaches nobody.
constexpr const char* kUnexplained = "a block of it is damaged";

// "PATH: cannot be read: WHY", without the name that GDAL gives as well.
Error unreadable_file(const std::string& path, const std::string& gdal_path, const std::string& why);

// A window in the grid's order as the file has it, whose rows or columns may run the other way.
struct StoredWindow {
    int column = 0, row = 0, columns = 0, rows = 0;
};
StoredWindow stored_window(const Window& window, const Flips& flips, GDALRasterBand& band);

// Turns what was read of such a window round into the grid's order; a sample is so many items.
template <class T>
void turn_back(const Window& window, const Flips& flips, std::span<T> samples, std::int64_t items = 1) {
    const std::int64_t stride = window.columns * items;
    if (flips.rows)
        for (std::int64_t top = 0, bottom = window.rows - 1; top < bottom; ++top, --bottom) {
            const auto row = samples.begin() + top * stride;
            std::swap_ranges(row, row + stride, samples.begin() + bottom * stride);
        }
    if (!flips.columns) return;
    for (std::int64_t row = 0; row < window.rows; ++row) {
        const auto first = samples.begin() + row * stride;
        for (std::int64_t west = 0, east = window.columns - 1; west < east; ++west, --east)
            std::swap_ranges(first + west * items, first + (west + 1) * items, first + east * items);
    }
}

// Reads a window given in the grid's order.
template <class T>
CPLErr read_band(GDALRasterBand& band, const Window& window, const Flips& flips, std::span<T> samples,
                 GDALDataType type) {
    const StoredWindow stored = stored_window(window, flips, band);
    const CPLErr status = band.RasterIO(GF_Read, stored.column, stored.row, stored.columns, stored.rows,
                                        samples.data(), stored.columns, stored.rows, type, 0, 0, nullptr);
    turn_back(window, flips, samples);
    return status;
}

}  // namespace ridgeline::raster
