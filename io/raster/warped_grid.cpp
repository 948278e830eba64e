// GDAL's warper does the work (gdal.org, "Warp API tutorial"); here a grid is made to look like a dataset to
// it.
//
// The kernel is kept bilinear where the warper would widen it (a source denser along one axis than the
// target, as degrees are in the north): heights stay values between their four neighbours.
#include "warped_grid.h"

#include <gdal_alg.h>
#include <gdal_priv.h>
#include <gdalwarper.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "gdal_session.h"
#include "warp_transformer.h"

namespace ridgeline::raster {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

}  // namespace

// A HeightGrid as the one-band dataset that the warper reads.
class WarpedGrid::SourceDataset : public GDALDataset {
  public:
    SourceDataset(std::shared_ptr<HeightGrid> grid, const Placement& placement)
        : grid_(std::move(grid)), placement_(placement) {
        nRasterXSize = static_cast<int>(grid_->width());
        nRasterYSize = static_cast<int>(grid_->height());
        SetBand(1, new Band(this));
    }
    CPLErr GetGeoTransform(double* transform) override {
        std::copy(placement_.world_from_pixel.begin(), placement_.world_from_pixel.end(), transform);
        return CE_None;
    }
    const OGRSpatialReference* GetSpatialRef() const override {
        return placement_.crs.IsEmpty() ? nullptr : &placement_.crs;
    }

    // The first failure to read the grid; what else the warper says (points beyond a projection) is no
    // failure.
    const std::optional<Error>& failure() const { return failure_; }

  private:
    class Band : public GDALRasterBand {
      public:
        explicit Band(SourceDataset* dataset) {
            poDS = dataset;
            nBand = 1;
            eDataType = GDT_Float64;
            nBlockXSize = std::min(256, dataset->GetRasterXSize());
            nBlockYSize = std::min(256, dataset->GetRasterYSize());
        }
        double GetNoDataValue(int* declared) override {
            if (declared) *declared = TRUE;
            return kNone;
        }
        CPLErr IReadBlock(int block_column, int block_row, void* data) override {
            auto& source = *static_cast<SourceDataset*>(poDS);
            auto& grid = *source.grid_;
            Window window{std::int64_t{block_column} * nBlockXSize, std::int64_t{block_row} * nBlockYSize, 0,
                          0};
            window.columns = std::min<std::int64_t>(nBlockXSize, grid.width() - window.column);
            window.rows = std::min<std::int64_t>(nBlockYSize, grid.height() - window.row);
            heights_m_.resize(static_cast<std::size_t>(window.samples()));
            if (const auto read = grid.read_heights(window, heights_m_); !read) {
                if (!source.failure_) source.failure_ = read.error();
                return CE_Failure;
            }
            // Blocks at the rim are shorter than their rows in memory.
            for (std::int64_t row = 0; row < window.rows; ++row)
                std::copy_n(heights_m_.begin() + row * window.columns, window.columns,
                            static_cast<double*>(data) + row * nBlockXSize);
            return CE_None;
        }

      private:
        std::vector<double> heights_m_;
    };

    std::shared_ptr<HeightGrid> grid_;
    Placement placement_;
    std::optional<Error> failure_;
};

void WarpedGrid::Release::operator()(GDALDataset* dataset) const { dataset->ReleaseRef(); }

namespace {

// Moves the edges of an extent outwards onto the lattice's sample borders.
void fall_in_with(const Placement& lattice, const std::array<double, 4>& extent, Placement& placement) {
    const double dx = lattice.spacing_x();
    const double dy = lattice.spacing_y();
    const double left = lattice.world_from_pixel[0];
    const double top = lattice.world_from_pixel[3];
    const double first_column = std::floor((extent[0] - left) / dx);
    const double first_row = std::floor((top - extent[3]) / dy);
    placement.width = static_cast<std::int64_t>(std::ceil((extent[2] - left) / dx) - first_column);
    placement.height = static_cast<std::int64_t>(std::ceil((top - extent[1]) / dy) - first_row);
    placement.world_from_pixel = {left + first_column * dx, dx, 0, top - first_row * dy, 0, -dy};
}

// The extent that holds the source, at about the source's spacing, with square samples unless a lattice is
// given.
Result<Placement> target_placement(GDALDataset& source, void* transformer, const WarpTarget& target,
                                   const GdalMessages& messages) {
    Placement placement;
    placement.crs = target.crs;
    placement.georeferenced = true;
    std::array<double, 4> extent{};  // west, south, east, north
    int width = 0;
    int height = 0;
    if (GDALSuggestedWarpOutput2(GDALDataset::ToHandle(&source), GDALGenImgProjTransform, transformer,
                                 placement.world_from_pixel.data(), &width, &height, extent.data(),
                                 0) != CE_None)
        return Error{"cannot be warped to the store's CRS: " + messages.why("no transformation")};
    placement.width = width;
    placement.height = height;
    if (target.lattice) fall_in_with(*target.lattice, extent, placement);
    constexpr std::int64_t kMost = std::numeric_limits<int>::max();
    if (placement.width < 1 || placement.height < 1 || placement.width > kMost || placement.height > kMost)
        return Error{"cannot be warped to the store's CRS: it would have " + std::to_string(placement.width) +
                     " x " + std::to_string(placement.height) + " samples"};
    return placement;
}

using WarpOptions = std::unique_ptr<GDALWarpOptions, decltype(&GDALDestroyWarpOptions)>;

WarpOptions bilinear_options(GDALDataset& source, int threads) {
    WarpOptions options(GDALCreateWarpOptions(), &GDALDestroyWarpOptions);
    options->hSrcDS = GDALDataset::ToHandle(&source);
    options->eResampleAlg = GRA_Bilinear;
    options->eWorkingDataType = GDT_Float64;
    GDALWarpInitDefaultBandMapping(options.get(), 1);
    GDALWarpInitSrcNoDataReal(options.get(), kNone);
    GDALWarpInitDstNoDataReal(options.get(), kNone);
    const auto set = [&options](const char* name, const char* value) {
        options->papszWarpOptions = CSLSetNameValue(options->papszWarpOptions, name, value);
    };
    set("INIT_DEST", "NO_DATA");
    set("XSCALE", "1");
    set("YSCALE", "1");
    // Looks inside windows too for the source they need: a pole is on no window's edge.
    set("SAMPLE_GRID", "YES");
    set("NUM_THREADS", std::to_string(threads).c_str());
    return options;
}

}  // namespace

WarpedGrid::WarpedGrid() = default;
WarpedGrid::~WarpedGrid() = default;

Result<std::shared_ptr<WarpedGrid>> WarpedGrid::create(std::shared_ptr<HeightGrid> source,
                                                       const Placement& from, const WarpTarget& target) {
    const GdalMessages messages;
    std::unique_ptr<SourceDataset, Release> dataset(new SourceDataset(std::move(source), from));
    Transformer exact = make_transformer(*dataset, from.crs, target.crs);
    if (!exact) return Error{"cannot be warped to the store's CRS: " + messages.why("no transformation")};
    auto placement = target_placement(*dataset, exact.get(), target, messages);
    if (!placement) return placement.error();
    Transformer approximate = approximated(std::move(exact), *placement);

    const WarpOptions options = bilinear_options(*dataset, target.threads);
    options->pfnTransformer = GDALApproxTransform;
    options->pTransformerArg = approximate.get();
    GDALDatasetH warped = GDALCreateWarpedVRT(options->hSrcDS, static_cast<int>(placement->width),
                                              static_cast<int>(placement->height),
                                              placement->world_from_pixel.data(), options.get());
    if (!warped) return Error{"cannot be warped to the store's CRS: " + messages.why("GDAL gives no reason")};
    static_cast<void>(approximate.release());  // the warped dataset destroys it
    std::shared_ptr<WarpedGrid> grid(new WarpedGrid);
    grid->warped_.reset(GDALDataset::FromHandle(warped));
    grid->placement_ = *placement;
    grid->source_ = std::move(dataset);
    return grid;
}

std::int64_t WarpedGrid::natural_rows() const {
    int columns = 1;
    int rows = 1;
    warped_->GetRasterBand(1)->GetBlockSize(&columns, &rows);
    return rows;
}

Result<void> WarpedGrid::read_heights(const Window& window, std::span<double> heights_m) {
    RIDGELINE_CHECK(static_cast<std::int64_t>(heights_m.size()) == window.samples());
    const GdalMessages messages;
    const int columns = static_cast<int>(window.columns);
    const int rows = static_cast<int>(window.rows);
    const CPLErr status = warped_->GetRasterBand(1)->RasterIO(
        GF_Read, static_cast<int>(window.column), static_cast<int>(window.row), columns, rows,
        heights_m.data(), columns, rows, GDT_Float64, 0, 0, nullptr);
    if (source_->failure()) return *source_->failure();
    if (status == CE_None) return {};
    return Error{messages.why("warping failed, and GDAL gives no reason")};
}

Result<void> WarpedGrid::read_steps(const Window&, std::span<std::int32_t>) {
    RIDGELINE_CHECK(!"warped heights are no integers");
    return {};
}

}  // namespace ridgeline::raster
