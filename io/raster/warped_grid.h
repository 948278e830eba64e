// A grid resampled, bilinear, onto a north-up lattice of another plane, streamed by GDAL's warper.
//
// Heights outside the source and within half a sample of its nodata are nodata; nodata never mixes into
// heights. One thread at a time; GDAL warps on as many threads as it was given.
#pragma once

#include <ogr_spatialref.h>

#include <array>
#include <memory>
#include <optional>

#include "height_grid.h"
#include "placement.h"

class GDALDataset;

namespace ridgeline::raster {

// The target's plane and, where other grids already lie on it, the lattice to fall in with.
struct WarpTarget {
    OGRSpatialReference crs;
    std::optional<Placement> lattice;
    int threads = 1;
};

class WarpedGrid : public HeightGrid {
  public:
    static Result<std::shared_ptr<WarpedGrid>> create(std::shared_ptr<HeightGrid> source,
                                                      const Placement& from, const WarpTarget& target);
    ~WarpedGrid() override;

    const Placement& placement() const { return placement_; }
    std::int64_t width() const override { return placement_.width; }
    std::int64_t height() const override { return placement_.height; }
    HeightFormat format() const override { return {}; }
    std::int64_t natural_rows() const override;
    Result<void> read_heights(const Window& window, std::span<double> heights_m) override;
    Result<void> read_steps(const Window& window, std::span<std::int32_t> steps) override;

  private:
    class SourceDataset;
    struct Release {
        void operator()(GDALDataset* dataset) const;
    };
    WarpedGrid();

    Placement placement_;
    std::unique_ptr<SourceDataset, Release> source_;
    std::unique_ptr<GDALDataset, Release> warped_;  // reads from source_
};

}  // namespace ridgeline::raster
