#include "ridgeline/select/horizon_profile.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ridgeline::select {

ColumnPlace column_place(Angle azimuth) {
    constexpr double kSector = std::numbers::pi / 2.0;
    const double turns = std::round(azimuth.radians() / kSector);
    const double within = azimuth.radians() - turns * kSector;
    const int sector = static_cast<int>(turns - 4.0 * std::floor(turns / 4.0));
    const double u = std::tan(within);
    const bool right_half = u >= 0.0;
    const double place = (right_half ? u : u + 1.0) * static_cast<double>(SliceView::kPlacesPerUnit);
    return {.slice = 2 * sector + (right_half ? 1 : 0),
            .column = std::clamp(static_cast<int>(std::floor(place)), 0, HorizonColumns::kCount - 1),
            .slope_per_value = std::cos(within)};
}

void horizon_profile(const Selection& selection, Angle from, Angle to, std::span<float> slopes) {
    const double step = (to - from).radians() / static_cast<double>(slopes.size());
    for (std::size_t i = 0; i < slopes.size(); ++i) {
        const double azimuth = from.radians() + (static_cast<double>(i) + 0.5) * step;
        const ColumnPlace place = column_place(Angle::from_radians(azimuth));
        const std::span<const float> columns = selection.horizon_columns(place.slice);
        const float value = columns.empty() ? kNotLookedAt : columns[static_cast<std::size_t>(place.column)];
        slopes[i] = value > kNotLookedAt || std::isinf(value)
                        ? value * static_cast<float>(place.slope_per_value)
                        : kNotLookedAt;
    }
}

}  // namespace ridgeline::select
