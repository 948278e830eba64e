#include "ridgeline/telemetry/summary.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ridgeline::telemetry {

std::uint64_t nearest_rank(double share, std::uint64_t count) {
    // 0.95 of 100 is 95, although 0.95 as a double is slightly more.
    constexpr double kRounding = 1e-9;
    const auto rank = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(count) - kRounding));
    return std::clamp<std::uint64_t>(rank, 1, count);
}

Summary summarise(std::span<double> values) {
    if (values.empty()) return {};
    std::ranges::sort(values);
    const auto at = [values](double share) { return values[nearest_rank(share, values.size()) - 1]; };
    const double sum = std::accumulate(values.begin(), values.end(), 0.0);
    return {.count = values.size(),
            .mean = sum / static_cast<double>(values.size()),
            .p50 = at(0.50),
            .p95 = at(0.95),
            .p99 = at(0.99),
            .p999 = at(0.999),
            .max = values.back()};
}

}  // namespace ridgeline::telemetry
