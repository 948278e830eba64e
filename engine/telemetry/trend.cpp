// The method of batch means: Law, "Simulation Modeling and Analysis", chapter 9; then ordinary least squares
// over the batches. Values that are off by up to r, evenly, have a variance of r²/3, which batches share: what
// a counter is off by now, it is off by in the next second.
#include "ridgeline/telemetry/trend.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "ridgeline/base/contract.h"

namespace ridgeline::telemetry {
namespace {

TrendSample mean_of(std::span<const TrendSample> samples) {
    TrendSample sum;
    for (const TrendSample& sample : samples) {
        sum.time_s += sample.time_s;
        sum.value += sample.value;
    }
    const auto count = static_cast<double>(samples.size());
    return {sum.time_s / count, sum.value / count};
}

}  // namespace

Trend trend_of(std::span<const TrendSample> samples, double resolution) {
    constexpr double kHour_s = 3600.0;
    RIDGELINE_CHECK(samples.size() >= std::size_t{Trend::kParts});
    const std::size_t length = samples.size() / std::size_t{Trend::kParts};
    samples = samples.last(length * std::size_t{Trend::kParts});
    std::array<TrendSample, Trend::kParts> parts;
    for (std::size_t i = 0; i < parts.size(); ++i) parts[i] = mean_of(samples.subspan(i * length, length));
    const TrendSample middle = mean_of(parts);
    double spread = 0.0, together = 0.0;
    for (const TrendSample& part : parts) {
        spread += (part.time_s - middle.time_s) * (part.time_s - middle.time_s);
        together += (part.time_s - middle.time_s) * (part.value - middle.value);
    }
    const double slope = together / spread;
    double scatter = 0.0;
    for (const TrendSample& part : parts) {
        const double off = part.value - middle.value - slope * (part.time_s - middle.time_s);
        scatter += off * off;
    }
    const double variance = std::max(scatter / (Trend::kParts - 2), resolution * resolution / 3.0);
    return {middle.value, kHour_s * slope, kHour_s * std::sqrt(variance / spread)};
}

}  // namespace ridgeline::telemetry
