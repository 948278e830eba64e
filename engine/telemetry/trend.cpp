// The method of batch means: Law, "Simulation Modeling and Analysis", chapter 9; then ordinary least squares
// over the batches. Places of a round are found with the line by backfitting (Hastie, Tibshirani, "Generalized
// Additive Models"). Values that are off by up to r, evenly, have a variance of r²/3, which batches share: what
// a counter is off by now, it is off by in the next second.
#include "ridgeline/telemetry/trend.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

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

struct Line {
    TrendSample middle;
    double slope = 0.0;
    double variance = 0.0;  // of the parts about it
    double spread = 0.0;
};

Line fit(std::span<const TrendSample> samples) {
    const std::size_t length = samples.size() / std::size_t{Trend::kParts};
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
    return {middle, slope, scatter / (Trend::kParts - 2), spread};
}

// What each place of the round adds to the values about a line, taken off them.
void take_off_places(std::span<const TrendSample> samples, const Line& line,
                     std::span<TrendSample> adjusted) {
    constexpr std::size_t kPlaces = 32;
    struct Place {
        double sum = 0.0;
        double count = 0.0;
    };
    std::array<Place, kPlaces> places{};
    const auto place_of = [&](const TrendSample& sample) -> Place& {
        const double share = sample.rounds - std::floor(sample.rounds);
        return places[std::min(static_cast<std::size_t>(share * double{kPlaces}), kPlaces - 1)];
    };
    for (const TrendSample& sample : samples) {
        Place& place = place_of(sample);
        place.sum += sample.value - line.middle.value - line.slope * (sample.time_s - line.middle.time_s);
        place.count += 1.0;
    }
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const Place& place = place_of(samples[i]);
        adjusted[i].value = samples[i].value - place.sum / place.count;
    }
}

}  // namespace

Trend trend_of(std::span<const TrendSample> samples, double resolution) {
    constexpr double kHour_s = 3600.0, kLeastRounds = 3.0;
    // Line and places in turn; after so many they stay as they are.
    constexpr int kTurns = 20;
    RIDGELINE_CHECK(samples.size() >= std::size_t{Trend::kParts});
    samples = samples.last(samples.size() / Trend::kParts * Trend::kParts);
    Line line = fit(samples);
    const double rounds = samples.back().rounds - samples.front().rounds;
    if (rounds >= kLeastRounds) {
        std::vector<TrendSample> adjusted(samples.begin(), samples.end());
        for (int i = 0; i < kTurns; ++i) {
            take_off_places(samples, line, adjusted);
            line = fit(adjusted);
        }
        // The places' means have taken their share of the noise along.
        line.variance *= rounds / (rounds - 1.0);
    }
    const double variance = std::max(line.variance, resolution * resolution / 3.0);
    return {line.middle.value, kHour_s * line.slope, kHour_s * std::sqrt(variance / line.spread)};
}

}  // namespace ridgeline::telemetry
