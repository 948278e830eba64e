// As warped_grid.cpp, for colours: alpha weighs what is mixed, and comes out as its own mean.
#include "warped_image.h"

#include <gdal_priv.h>
#include <gdalwarper.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "gdal_session.h"
#include "warp_transformer.h"

namespace ridgeline::raster {
namespace {

constexpr int kBands = 4;
// Half of what surrounds a texel is there.
constexpr std::uint8_t kLeastAlpha = 128;
// Small enough for few rows of them to fill a cache, large enough that GDAL's calls cost nothing.
constexpr int kBlock = 256;

}  // namespace

// An ImageGrid as the four-band dataset that the warper reads. A block of all bands is read at once and
// serves the four requests that follow one another.
class WarpedImage::SourceDataset : public GDALDataset {
  public:
    SourceDataset(std::shared_ptr<ImageGrid> grid, const Placement& placement)
        : grid_(std::move(grid)), placement_(placement) {
        nRasterXSize = static_cast<int>(grid_->width());
        nRasterYSize = static_cast<int>(grid_->height());
        for (int number = 1; number <= kBands; ++number) SetBand(number, new Band(this, number));
    }
    CPLErr GetGeoTransform(double* transform) override {
        std::copy(placement_.world_from_pixel.begin(), placement_.world_from_pixel.end(), transform);
        return CE_None;
    }
    const OGRSpatialReference* GetSpatialRef() const override {
        return placement_.crs.IsEmpty() ? nullptr : &placement_.crs;
    }
    // The first failure to read the grid.
    const std::optional<Error>& failure() const { return failure_; }

  private:
    class Band : public GDALRasterBand {
      public:
        Band(SourceDataset* dataset, int number) {
            poDS = dataset;
            nBand = number;
            eDataType = GDT_Byte;
            nBlockXSize = std::min(kBlock, dataset->GetRasterXSize());
            nBlockYSize = std::min(kBlock, dataset->GetRasterYSize());
        }
        GDALColorInterp GetColorInterpretation() override {
            constexpr GDALColorInterp kMeanings[kBands] = {GCI_RedBand, GCI_GreenBand, GCI_BlueBand,
                                                           GCI_AlphaBand};
            return kMeanings[nBand - 1];
        }
        CPLErr IReadBlock(int column, int row, void* data) override {
            auto& source = *static_cast<SourceDataset*>(poDS);
            const Window window{std::int64_t{column} * nBlockXSize, std::int64_t{row} * nBlockYSize,
                                std::min<std::int64_t>(nBlockXSize, nRasterXSize - column * nBlockXSize),
                                std::min<std::int64_t>(nBlockYSize, nRasterYSize - row * nBlockYSize)};
            if (!source.load(window)) return CE_Failure;
            auto* bytes = static_cast<std::uint8_t*>(data);
            for (std::int64_t y = 0; y < window.rows; ++y)
                for (std::int64_t x = 0; x < window.columns; ++x)
                    bytes[y * nBlockXSize + x] = source.loaded_[static_cast<std::size_t>(
                        (y * window.columns + x) * kColourBytes + nBand - 1)];
            return CE_None;
        }
    };

    bool load(const Window& window) {
        if (window.column == window_.column && window.row == window_.row && !loaded_.empty()) return true;
        loaded_.resize(static_cast<std::size_t>(window.samples() * kColourBytes));
        window_ = window;
        if (const auto read = grid_->read(window, loaded_); !read) {
            if (!failure_) failure_ = read.error();
            loaded_.clear();
            return false;
        }
        return true;
    }

    std::shared_ptr<ImageGrid> grid_;
    Placement placement_;
    Window window_;
    std::vector<std::uint8_t> loaded_;
    std::optional<Error> failure_;
};

void WarpedImage::Release::operator()(GDALDataset* dataset) const { dataset->ReleaseRef(); }

WarpedImage::WarpedImage() = default;
WarpedImage::~WarpedImage() = default;

namespace {

Error unplaceable(const GdalMessages& messages) {
    return Error{"cannot be warped to the store's CRS: " + messages.why("no transformation")};
}

using WarpOptions = std::unique_ptr<GDALWarpOptions, decltype(&GDALDestroyWarpOptions)>;

WarpOptions bilinear_options(GDALDataset& source, int threads) {
    WarpOptions options(GDALCreateWarpOptions(), &GDALDestroyWarpOptions);
    options->hSrcDS = GDALDataset::ToHandle(&source);
    options->eResampleAlg = GRA_Bilinear;
    options->eWorkingDataType = GDT_Byte;
    options->nBandCount = kBands - 1;
    options->panSrcBands = static_cast<int*>(CPLMalloc(sizeof(int) * (kBands - 1)));
    options->panDstBands = static_cast<int*>(CPLMalloc(sizeof(int) * (kBands - 1)));
    for (int i = 0; i < kBands - 1; ++i) options->panSrcBands[i] = options->panDstBands[i] = i + 1;
    options->nSrcAlphaBand = options->nDstAlphaBand = kBands;
    const auto set = [&options](const char* name, const char* value) {
        options->papszWarpOptions = CSLSetNameValue(options->papszWarpOptions, name, value);
    };
    set("INIT_DEST", "0");
    set("XSCALE", "1");
    set("YSCALE", "1");
    // Looks inside windows too for the source they need: a pole is on no window's edge.
    set("SAMPLE_GRID", "YES");
    set("NUM_THREADS", std::to_string(threads).c_str());
    return options;
}

}  // namespace

Result<Placement> suggested_placement(std::shared_ptr<ImageGrid> source, const Placement& from,
                                      const OGRSpatialReference& to) {
    const GdalMessages messages;
    const std::unique_ptr<WarpedImage::SourceDataset, WarpedImage::Release> dataset(
        new WarpedImage::SourceDataset(std::move(source), from));
    const Transformer transformer = make_transformer(*dataset, from.crs, to);
    if (!transformer) return unplaceable(messages);
    Placement placement;
    placement.crs = to;
    placement.georeferenced = true;
    std::array<double, 4> extent{};
    int width = 0, height = 0;
    if (GDALSuggestedWarpOutput2(GDALDataset::ToHandle(dataset.get()), GDALGenImgProjTransform,
                                 transformer.get(), placement.world_from_pixel.data(), &width, &height,
                                 extent.data(), 0) != CE_None)
        return unplaceable(messages);
    placement.width = width;
    placement.height = height;
    return placement;
}

Result<std::shared_ptr<WarpedImage>> WarpedImage::create(std::shared_ptr<ImageGrid> source,
                                                         const Placement& from, const Placement& target,
                                                         int threads) {
    const GdalMessages messages;
    constexpr std::int64_t kMost = std::numeric_limits<int>::max();
    if (target.width > kMost || target.height > kMost)
        return Error{"cannot be warped to the store's CRS: it would have " + std::to_string(target.width) +
                     " x " + std::to_string(target.height) + " texels"};
    std::unique_ptr<SourceDataset, Release> dataset(new SourceDataset(std::move(source), from));
    Transformer exact = make_transformer(*dataset, from.crs, target.crs);
    if (!exact) return unplaceable(messages);
    Transformer approximate = approximated(std::move(exact), target);
    const WarpOptions options = bilinear_options(*dataset, threads);
    options->pfnTransformer = GDALApproxTransform;
    options->pTransformerArg = approximate.get();
    auto transform = target.world_from_pixel;
    GDALDatasetH warped =
        GDALCreateWarpedVRT(options->hSrcDS, static_cast<int>(target.width), static_cast<int>(target.height),
                            transform.data(), options.get());
    if (!warped) return unplaceable(messages);
    static_cast<void>(approximate.release());  // the warped dataset destroys it
    std::shared_ptr<WarpedImage> image(new WarpedImage);
    image->width_ = target.width;
    image->height_ = target.height;
    image->warped_.reset(GDALDataset::FromHandle(warped));
    image->source_ = std::move(dataset);
    return image;
}

Result<void> WarpedImage::read(const Window& window, std::span<std::uint8_t> rgba) {
    RIDGELINE_CHECK(static_cast<std::int64_t>(rgba.size()) == window.samples() * kColourBytes);
    const GdalMessages messages;
    const int columns = static_cast<int>(window.columns), rows = static_cast<int>(window.rows);
    const CPLErr status = warped_->RasterIO(
        GF_Read, static_cast<int>(window.column), static_cast<int>(window.row), columns, rows, rgba.data(),
        columns, rows, GDT_Byte, kBands, nullptr, kColourBytes, kColourBytes * window.columns, 1, nullptr);
    if (source_->failure()) return *source_->failure();
    if (status != CE_None) return Error{messages.why("warping failed, and GDAL gives no reason")};
    for (std::size_t i = 0; i < rgba.size(); i += kColourBytes) {
        if (rgba[i + 3] >= kLeastAlpha)
            rgba[i + 3] = kOpaqueAlpha;
        else
            std::fill_n(&rgba[i], kColourBytes, std::uint8_t{0});
    }
    return {};
}

}  // namespace ridgeline::raster
