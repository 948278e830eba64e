// Several grids on one lattice as one: later parts cover earlier ones wherever they have a height.
#pragma once

#include <vector>

#include "height_grid.h"

namespace ridgeline::raster {

class Mosaic : public HeightGrid {
  public:
    // A grid and where its first sample lies in the mosaic.
    struct Part {
        std::shared_ptr<HeightGrid> grid;
        std::int64_t column = 0;
        std::int64_t row = 0;
    };
    // The extent is that of the parts, whose least column and row must be 0.
    explicit Mosaic(std::vector<Part> parts);

    std::int64_t width() const override { return width_; }
    std::int64_t height() const override { return height_; }
    HeightFormat format() const override { return format_; }
    std::int64_t natural_rows() const override { return natural_rows_; }
    Result<void> read_heights(const Window& window, std::span<double> heights_m) override;
    Result<void> read_steps(const Window& window, std::span<std::int32_t> steps) override;

  private:
    std::vector<Part> parts_;
    std::int64_t width_ = 0;
    std::int64_t height_ = 0;
    HeightFormat format_;
    std::int64_t natural_rows_ = 1;
    std::vector<double> part_heights_;
    std::vector<std::int32_t> part_steps_;
};

}  // namespace ridgeline::raster
