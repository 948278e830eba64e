// What picture files, mosaics and warped views of them have in common: a grid of colours from which windows
// are read.
//
// A colour is four bytes: red, green, blue, sRGB-coded, and 255, or four zeros where there is no picture. Row
// 0 is the first row as placed. One thread at a time.
#pragma once

#include <cstdint>
#include <span>

#include "height_grid.h"
#include "ridgeline/base/result.h"

namespace ridgeline::raster {

constexpr std::int64_t kColourBytes = 4;
constexpr std::uint8_t kOpaqueAlpha = 255;

class ImageGrid {
  public:
    virtual ~ImageGrid() = default;

    virtual std::int64_t width() const = 0;
    virtual std::int64_t height() const = 0;
    // The window's colours row by row. The window lies inside the grid.
    virtual Result<void> read(const Window& window, std::span<std::uint8_t> rgba) = 0;
};

}  // namespace ridgeline::raster
