#include "ridgeline/app/bench/lost_lags.h"

#include <cstddef>

namespace ridgeline::app {
namespace {

double squared_differences(std::span<const double> heights_m, int side, int lag) {
    double sum = 0.0;
    for (int row = 0; row < side; ++row)
        for (int column = 0; column + lag < side; ++column) {
            const auto at = static_cast<std::size_t>(row * side + column);
            const double apart = heights_m[at + static_cast<std::size_t>(lag)] - heights_m[at];
            sum += apart * apart;
        }
    return sum;
}

}  // namespace

void LostLags::add(std::span<const double> real_m, std::span<const double> made_m, int side) {
    for (int lag = 0; lag < kLags; ++lag) {
        const auto i = static_cast<std::size_t>(lag);
        real_[i] += squared_differences(real_m, side, samples(lag));
        made_[i] += squared_differences(made_m, side, samples(lag));
    }
}

double LostLags::ratio(int lag) const {
    const auto i = static_cast<std::size_t>(lag);
    return real_[i] > 0.0 ? made_[i] / real_[i] : 0.0;
}

}  // namespace ridgeline::app
