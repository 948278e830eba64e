// Trends: a line's slope exactly, chance told from growth as often as promised, also where one second is much
// like the last.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "ridgeline/telemetry/trend.h"

using namespace ridgeline::telemetry;

namespace {

template <class Value>
std::vector<TrendSample> series(int count, const Value& value) {
    std::vector<TrendSample> samples;
    for (int i = 0; i < count; ++i) samples.push_back({1000.0 + i, value(i)});
    return samples;
}

// Of so many level series, those that are taken for rising or falling.
template <class Noise>
int mistaken(int trials, const Noise& noise) {
    std::mt19937_64 random(1);
    int wrong = 0;
    for (int i = 0; i < trials; ++i) {
        double state = 0.0;
        const Trend trend = trend_of(series(600, [&](int at) { return 100.0 + noise(random, state, at); }));
        wrong += trend.rises() || trend.falls();
    }
    return wrong;
}

double normal(std::mt19937_64& random) { return std::normal_distribution<double>()(random); }

}  // namespace

TEST_CASE("trend: of a line its slope and no error, of a level series neither") {
    const Trend line = trend_of(series(123, [](int i) { return 5.0 + 0.25 * i; }));
    CHECK(line.per_hour == doctest::Approx(900.0));
    CHECK(line.error_per_hour == doctest::Approx(0.0).epsilon(1e-6));
    CHECK(line.rises());
    CHECK(!line.falls());
    const Trend fall = trend_of(series(123, [](int i) { return -0.25 * i; }));
    CHECK(fall.falls());
    const Trend level = trend_of(series(12, [](int) { return 7.0; }));
    CHECK(level.mean == 7.0);
    CHECK(level.per_hour == 0.0);
    CHECK(!level.rises());
    CHECK(!level.falls());
}

TEST_CASE("trend: chance is taken for growth about once in a hundred series") {
    CHECK(mistaken(1000, [](auto& random, double&, int) { return normal(random); }) < 25);
    // Each second nine tenths of the last.
    CHECK(mistaken(1000, [](auto& random, double& state, int) {
              return state = 0.9 * state + normal(random);
          }) < 30);
    // A round of a minute, from anywhere.
    CHECK(mistaken(1000, [](auto& random, double& state, int at) {
              if (at == 0) state = 6.0 * normal(random);
              return std::sin(state + 2.0 * std::numbers::pi * at / 60.0);
          }) < 25);
}

TEST_CASE("trend: growth of twice what would be told is found") {
    std::mt19937_64 random(2);
    const Trend noise = trend_of(series(600, [&](int) { return normal(random); }));
    const double slope = 2.0 * noise.least_told_per_hour() / 3600.0;
    int found = 0;
    for (int i = 0; i < 100; ++i)
        found += trend_of(series(600, [&](int at) { return slope * at + normal(random); })).rises();
    CHECK(found > 90);
}

TEST_CASE("trend: a step that measuring may have made is none") {
    const auto step = series(600, [](int i) { return i < 300 ? 1000.0 : 1010.0; });
    CHECK(trend_of(step).rises());
    CHECK(!trend_of(step, 10.0).rises());
    CHECK(trend_of(step, 1.0).rises());
}

TEST_CASE("trend: what belongs to a place of the round hides no growth") {
    std::mt19937_64 random(3);
    // Four and a half rounds, which swing a hundred times as far as the noise.
    const auto walk = [&](double slope) {
        auto samples = series(600, [&](int i) {
            return slope * i + normal(random) + 100.0 * std::sin(2.0 * std::numbers::pi * i / 133.0);
        });
        const Trend blind = trend_of(samples);
        for (std::size_t i = 0; i < samples.size(); ++i) samples[i].rounds = static_cast<double>(i) / 133.0;
        const Trend seeing = trend_of(samples);
        CHECK(seeing.error_per_hour < 0.1 * blind.error_per_hour);
        return seeing;
    };
    CHECK(walk(0.05).per_hour == doctest::Approx(180.0).epsilon(0.2));
    int wrong = 0;
    for (int i = 0; i < 100; ++i) {
        const Trend level = walk(0.0);
        wrong += level.rises() || level.falls();
    }
    CHECK(wrong < 6);
    CHECK(walk(0.05).rises());
}
