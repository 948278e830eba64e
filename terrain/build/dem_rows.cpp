#include <algorithm>
#include <cmath>

#include "ridgeline/build/height_rows.h"
#include "ridgeline/raster/dem_source.h"

namespace ridgeline::build {
namespace {

// A quantum of a 64th of the spacing keeps slopes between neighbours to a 64th; 2^-13 m is finer than any
// survey and still spans 32 km either way.
constexpr double kCoarsestQuantum_m = 1.0 / 32;
constexpr double kFinestQuantum_m = 1.0 / 8192;

double float_quantum_m(const raster::RasterInfo& info) {
    const double spacing_m = std::min(info.spacing_x_m, info.spacing_y_m);
    const double fine_m = std::exp2(std::floor(std::log2(spacing_m / 64)));
    return std::clamp(fine_m, kFinestQuantum_m, kCoarsestQuantum_m);
}

io::TerrainInfo describe(const raster::RasterInfo& raster) {
    io::TerrainInfo info;
    info.crs_wkt = raster.crs_wkt;
    info.west_m = raster.west_east_m;
    info.north_m = raster.north_north_m;
    info.spacing_x_m = raster.spacing_x_m;
    info.spacing_y_m = raster.spacing_y_m;
    info.width = raster.width;
    info.height = raster.height;
    info.quantum_m = raster.integer_heights ? raster.step_m : float_quantum_m(raster);
    info.height_offset_m = raster.integer_heights ? raster.offset_m : 0.0;
    info.sources = raster.sources;
    info.notes = raster.notes;
    return info;
}

class DemRows final : public HeightRows {
  public:
    explicit DemRows(raster::DemSource source)
        : source_(std::move(source)), info_(describe(source_.info())) {}

    const io::TerrainInfo& info() const override { return info_; }
    bool may_have_nodata() const override { return source_.info().may_have_nodata || too_far_ > 0; }
    std::int64_t natural_rows() const override {
        return std::max<std::int64_t>(1, source_.info().natural_rows);
    }

    Result<void> read(std::int64_t row, std::int64_t rows, std::span<std::int32_t> quanta) override {
        return source_.info().integer_heights ? read_steps(row, rows, quanta)
                                              : read_heights(row, rows, quanta);
    }

    std::vector<std::string> findings() const override {
        auto lines = source_.findings();
        if (too_far_ > 0)
            lines.push_back(std::to_string(too_far_) + " samples lie beyond " +
                            std::to_string(std::lround(kMaxQuanta * info_.quantum_m)) +
                            " m, more than the quantum allows: taken as nodata");
        return lines;
    }

  private:
    Result<void> read_steps(std::int64_t row, std::int64_t rows, std::span<std::int32_t> quanta) {
        RIDGELINE_TRY(source_.read_steps(row, rows, quanta));
        static_assert(raster::kNoStep == kNoHeight);
        for (std::int32_t& step : quanta)
            if (step < -kMaxQuanta || step > kMaxQuanta)
                too_far_ += std::exchange(step, kNoHeight) != kNoHeight;
        return {};
    }

    Result<void> read_heights(std::int64_t row, std::int64_t rows, std::span<std::int32_t> quanta) {
        heights_m_.resize(quanta.size());
        RIDGELINE_TRY(source_.read_rows(row, rows, heights_m_));
        for (std::size_t i = 0; i < quanta.size(); ++i) {
            const double steps = std::floor(heights_m_[i] / info_.quantum_m + 0.5);
            const bool fits = steps >= -kMaxQuanta && steps <= kMaxQuanta;  // not so for NaN
            quanta[i] = fits ? static_cast<std::int32_t>(steps) : kNoHeight;
            too_far_ += !fits && !std::isnan(steps);
        }
        return {};
    }

    raster::DemSource source_;
    io::TerrainInfo info_;
    std::vector<double> heights_m_;
    std::uint64_t too_far_ = 0;
};

}  // namespace

Result<std::unique_ptr<HeightRows>> open_dem(const DemOptions& options) {
    raster::RasterOptions raster;
    raster.crs = options.crs;
    raster.nodata = options.nodata;
    raster.cache_bytes = options.cache_bytes;
    raster.threads = options.threads;
    auto source = raster::DemSource::open(options.sources, raster);
    if (!source) return source.error();
    return std::unique_ptr<HeightRows>(std::make_unique<DemRows>(std::move(*source)));
}

}  // namespace ridgeline::build
