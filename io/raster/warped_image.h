// A picture resampled, bilinear, onto a north-up lattice of another plane, streamed by GDAL's warper.
//
// Texels whose surroundings are mostly without a picture are without one; no others mix with what is not
// there. One thread at a time; GDAL warps on as many threads as it was given.
#pragma once

#include <memory>
#include <optional>

#include "image_grid.h"
#include "placement.h"

class GDALDataset;

namespace ridgeline::raster {

// The extent and the square spacing at which a picture comes out about as fine as it is.
Result<Placement> suggested_placement(std::shared_ptr<ImageGrid> source, const Placement& from,
                                      const OGRSpatialReference& to);

class WarpedImage : public ImageGrid {
  public:
    // Onto the grid that `target` places.
    static Result<std::shared_ptr<WarpedImage>> create(std::shared_ptr<ImageGrid> source,
                                                       const Placement& from, const Placement& target,
                                                       int threads);
    ~WarpedImage() override;

    std::int64_t width() const override { return width_; }
    std::int64_t height() const override { return height_; }
    Result<void> read(const Window& window, std::span<std::uint8_t> rgba) override;

  private:
    struct Release {
        void operator()(GDALDataset* dataset) const;
    };
    class SourceDataset;
    friend Result<Placement> suggested_placement(std::shared_ptr<ImageGrid>, const Placement&,
                                                 const OGRSpatialReference&);
    WarpedImage();

    std::int64_t width_ = 0, height_ = 0;
    std::unique_ptr<SourceDataset, Release> source_;
    std::unique_ptr<GDALDataset, Release> warped_;  // reads from source_
};

}  // namespace ridgeline::raster
