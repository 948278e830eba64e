#include "image_range.h"

#include <algorithm>
#include <cstdio>

namespace ridgeline::raster {
namespace {

constexpr double kCutShare = 0.005;

double quantile(std::vector<double>& values, double share) {
    const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + at, values.end());
    return values[static_cast<std::size_t>(at)];
}

}  // namespace

ValueRange choose_range(std::vector<double> values, GDALDataType type) {
    if (values.empty()) return {};
    const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
    const double low = *least, high = *greatest;
    const bool fractions = GDALDataTypeIsFloating(type) != 0;
    if (fractions && low >= 0.0 && high <= 1.0) return {0.0, 1.0};
    if (low >= 0.0 && high <= 255.0) return {0.0, 255.0};
    const double black = quantile(values, kCutShare), white = quantile(values, 1.0 - kCutShare);
    if (type == GDT_UInt16 && white >= 32768.0) return {0.0, 65535.0};
    // A picture of one value: that is white.
    return white > black ? ValueRange{black, white} : ValueRange{black - 1.0, black};
}

std::string described(const ValueRange& range) {
    char text[96];
    std::snprintf(text, sizeof text, "values %g to %g become black to white", range.black, range.white);
    return text;
}

}  // namespace ridgeline::raster
