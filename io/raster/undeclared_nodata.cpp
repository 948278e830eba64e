// GDAL takes undeclared nodata as heights, which makes walls of 32 km. Ground is continuous: where a
// customary nodata value occurs and the next higher value of the band is far away, it is no ground.
#include "undeclared_nodata.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace ridgeline::raster {
namespace {

constexpr double kCustomaryNodata[] = {-32768.0, -32767.0, -9999.0};
// No slope on Earth leaves such a gap over a whole band, in metres or feet.
constexpr double kLeastGap = 1000.0;
// Bands up to this size are read whole, of larger ones so many rows.
constexpr std::int64_t kSmallBand = 4'000'000;
constexpr int kSampledRows = 8;

struct Lowest {
    double customary = std::numeric_limits<double>::infinity();  // the greatest that occurs
    bool found_customary = false;
    double other = std::numeric_limits<double>::infinity();

    void take(double value) {
        if (is_customary_nodata(value)) {
            customary = found_customary ? std::max(customary, value) : value;
            found_customary = true;
        } else if (std::isfinite(value) && value < other) {
            other = value;
        }
    }
};

}  // namespace

bool is_customary_nodata(double stored) {
    return std::find(std::begin(kCustomaryNodata), std::end(kCustomaryNodata), stored) !=
           std::end(kCustomaryNodata);
}

std::optional<double> undeclared_nodata(GDALRasterBand& band) {
    const int columns = band.GetXSize(), rows = band.GetYSize();
    const bool small = std::int64_t{columns} * rows <= kSmallBand;
    const int looked_at = small ? rows : std::min(rows, kSampledRows);
    std::vector<double> row(static_cast<std::size_t>(columns));
    Lowest lowest;
    for (int i = 0; i < looked_at; ++i) {
        const auto y = static_cast<int>((2 * std::int64_t{i} + 1) * rows / (2 * looked_at));
        if (band.RasterIO(GF_Read, 0, y, columns, 1, row.data(), columns, 1, GDT_Float64, 0, 0, nullptr) !=
            CE_None) {
            // Blocks that several threads failed to decode (GDAL 3.6) stay in the cache as if they were sound.
            band.GetDataset()->FlushCache();
            return {};
        }
        for (const double value : row) lowest.take(value);
    }
    const bool apart = lowest.found_customary && lowest.other < std::numeric_limits<double>::infinity() &&
                       lowest.other - lowest.customary >= kLeastGap;
    return apart ? std::optional(lowest.customary) : std::nullopt;
}

}  // namespace ridgeline::raster
