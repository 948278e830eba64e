// One picture file: its colours, however it stores them.
//
// Files open and close as SourceFile's do. One thread at a time.
#pragma once

#include <gdal_priv.h>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "image_grid.h"
#include "image_source.h"
#include "placement.h"
#include "raster_file.h"

namespace ridgeline::raster {

// Which stored values are black and white. Pictures of one mosaic share them, so that it shows no seams.
struct ValueRange {
    double black = 0.0;
    double white = 255.0;
};

struct ImageContext {
    ImageOptions options;
    ValueRange range;  // of files that are not of bytes
    OpenFiles open_files;
};

class ImageFile : public ImageGrid, public ReopenableFile {
  public:
    // Opens and judges the file: an Error names it.
    static Result<std::shared_ptr<ImageFile>> open(const std::string& path,
                                                   std::shared_ptr<ImageContext> context);
    ~ImageFile() override;

    std::int64_t width() const override { return placed_.placement.width; }
    std::int64_t height() const override { return placed_.placement.height; }
    Result<void> read(const Window& window, std::span<std::uint8_t> rgba) override;

    const std::string& path() const { return path_; }
    const PlacedDataset& placed() const { return placed_; }
    const std::vector<std::string>& notes() const { return notes_; }
    // Its values are to be mapped by the context's range.
    bool needs_range() const { return !bytes_; }
    GDALDataType data_type() const { return type_; }
    // Some of its colours' stored values, from all over it, those without a picture left out.
    Result<void> sample_values(std::vector<double>& values);

    void close() override { dataset_.reset(); }

  private:
    // What the bands are.
    enum class Colours { red_green_blue, grey, palette, cmyk };

    ImageFile(std::string path, std::shared_ptr<ImageContext> context);

    Result<void> reopen();
    Result<void> judge();
    Result<void> judge_bands();
    Result<void> judge_palette();
    void judge_visible();
    int band_of(GDALColorInterp interpretation) const;
    GDALRasterBand& band(int number) { return *dataset_->GetRasterBand(number); }

    // Into visible_: 0 where alpha or mask say that there is no picture.
    Result<void> read_visible(const Window& window);
    Result<void> read_bytes(const Window& window, std::span<std::uint8_t> rgba);
    Result<void> read_values(const Window& window, std::span<std::uint8_t> rgba);
    bool is_nodata(const std::uint8_t* stored) const;
    bool is_nodata(std::span<const double> stored) const;
    // Stored bytes of one colour in place into red, green, blue and alpha.
    void expand(std::uint8_t* rgba) const;
    Error unreadable(const std::string& why) const { return unreadable_file(path_, gdal_path_, why); }

    std::string path_;
    std::string gdal_path_;
    std::shared_ptr<ImageContext> context_;
    GDALDatasetUniquePtr dataset_;
    PlacedDataset placed_;
    std::vector<std::string> notes_;

    GDALDataType type_ = GDT_Byte;
    bool bytes_ = true;
    Colours colours_ = Colours::red_green_blue;
    std::vector<int> bands_;  // of the colours: 3, 1, 1 or 4
    int alpha_band_ = 0;      // 0: none
    double alpha_half_ = 128.0;
    bool has_mask_ = false;
    std::vector<std::optional<double>> nodata_;  // of the colours' bands
    std::array<std::array<std::uint8_t, 4>, 256> palette_{};
    std::vector<std::uint8_t> visible_;
    std::vector<double> values_;
    std::vector<std::vector<double>> stored_;  // by colour
};

}  // namespace ridgeline::raster
