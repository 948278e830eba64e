// One raster file: its heights, whatever type, scale, unit, nodata marks and row order it stores them with.
//
// Files open on first use and close again when more than a fixed number of others have been used since
// (OpenFiles), so that a mosaic may have more files than a process may have open. One thread at a time.
#pragma once

#include <gdal_priv.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dem_source.h"
#include "height_grid.h"
#include "placement.h"
#include "raster_file.h"

namespace ridgeline::raster {

// What the files of one DemSource share.
struct SourceContext {
    RasterOptions options;
    ReadCounts counts;
    double lowest_unsuspected_m = 0.0;
    OpenFiles open_files;
};

class SourceFile : public HeightGrid, public ReopenableFile {
  public:
    // Opens and judges the file: an Error names it.
    static Result<std::shared_ptr<SourceFile>> open(const std::string& path,
                                                    std::shared_ptr<SourceContext> context);
    ~SourceFile() override;

    std::int64_t width() const override { return placed_.placement.width; }
    std::int64_t height() const override { return placed_.placement.height; }
    HeightFormat format() const override { return format_; }
    std::int64_t natural_rows() const override { return natural_rows_; }
    Result<void> read_heights(const Window& window, std::span<double> heights_m) override;
    Result<void> read_steps(const Window& window, std::span<std::int32_t> steps) override;

    const Placement& placement() const { return placed_.placement; }
    const std::vector<std::string>& notes() const { return placed_.notes; }
    const std::string& path() const { return path_; }
    const std::string& driver() const { return driver_; }
    std::string data_type() const { return GDALGetDataTypeName(type_); }

    void close() override { dataset_.reset(); }

  private:
    SourceFile(std::string path, std::shared_ptr<SourceContext> context);

    Result<void> reopen();
    Result<void> judge();
    void judge_heights(GDALRasterBand& band);
    void judge_nodata(GDALRasterBand& band);
    void judge_undeclared_nodata(GDALRasterBand& band);
    Error unreadable(const std::string& why) const;

    // The stored values of a window, rows and columns in the grid's order.
    template <class T>
    Result<void> read_stored(const Window& window, std::span<T> stored);
    Result<void> read_mask(const Window& window);
    bool masked_out(std::size_t sample) const { return has_mask_ && mask_[sample] == 0; }

    double height_of(double stored);
    std::int32_t step_of(double stored);
    bool in_range(double height_m);

    std::string path_;
    std::string gdal_path_;
    std::shared_ptr<SourceContext> context_;
    GDALDatasetUniquePtr dataset_;
    PlacedDataset placed_;
    HeightFormat format_;
    std::int64_t natural_rows_ = 1;
    std::string driver_;

    GDALDataType type_ = GDT_Unknown;
    bool signed_byte_ = false;  // GDAL before 3.7 marks signed bytes by metadata only
    bool has_mask_ = false;
    std::optional<double> nodata_;
    double scale_m_ = 1.0;  // stored value to metres; may be negative
    double offset_m_ = 0.0;
    std::vector<std::uint8_t> mask_;
    std::vector<double> wide_;
};

}  // namespace ridgeline::raster
