// What sources, mosaics and warped views have in common: a grid of heights from which windows are read.
//
// Row 0 is the first row as placed (the northmost wherever the grid is north-up). One thread at a time.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "ridgeline/base/result.h"

namespace ridgeline::raster {

struct Window {
    std::int64_t column = 0;
    std::int64_t row = 0;
    std::int64_t columns = 0;
    std::int64_t rows = 0;

    std::int64_t samples() const { return columns * rows; }
};

struct HeightFormat {
    bool integer = false;  // heights are offset_m + k * step_m; else step and offset mean nothing
    double step_m = 1.0;
    double offset_m = 0.0;
    bool may_have_nodata = true;
};

class HeightGrid {
  public:
    virtual ~HeightGrid() = default;

    virtual std::int64_t width() const = 0;
    virtual std::int64_t height() const = 0;
    virtual HeightFormat format() const = 0;
    // Rows that come at once from the disk.
    virtual std::int64_t natural_rows() const = 0;

    // The window's heights row by row, NaN where there is none. The window lies inside the grid.
    virtual Result<void> read_heights(const Window& window, std::span<double> heights_m) = 0;
    // The same as integers k or kNoStep; only where format().integer.
    virtual Result<void> read_steps(const Window& window, std::span<std::int32_t> steps) = 0;
};

}  // namespace ridgeline::raster
