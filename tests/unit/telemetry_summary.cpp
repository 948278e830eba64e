#include "ridgeline/telemetry/summary.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <thread>
#include <vector>

#include "ridgeline/telemetry/histogram.h"

namespace ridgeline::telemetry {
namespace {

constexpr double kShares[] = {0.5, 0.95, 0.99, 0.999};
// A bucket is 1/128 of its lower end wide at most, and its middle is given.
constexpr double kHistogramError = 0.5 / 128;

std::vector<double> percentiles(const Summary& summary) {
    return {summary.p50, summary.p95, summary.p99, summary.p999};
}

// By the definition: the least value that at least the share of all do not exceed.
double slow_percentile(const std::vector<double>& values, double share) {
    double least = std::numeric_limits<double>::infinity();
    for (const double value : values) {
        const auto not_above =
            std::ranges::count_if(values, [value](double other) { return other <= value; });
        if (static_cast<double>(not_above) >= share * static_cast<double>(values.size()) - 1e-9)
            least = std::min(least, value);
    }
    return least;
}

TEST_CASE("summarise finds the percentiles of the definition, for series of any length") {
    std::mt19937 random(3);
    for (const std::size_t count : {1U, 2U, 3U, 19U, 20U, 21U, 100U, 101U, 999U, 1000U, 1001U}) {
        std::vector<double> values(count);
        for (double& value : values) value = static_cast<double>(random() % 500);
        auto sorted = values;
        const auto summary = summarise(sorted);
        CAPTURE(count);
        CHECK(summary.count == count);
        CHECK(summary.max == std::ranges::max(values));
        for (std::size_t which = 0; which < std::size(kShares); ++which)
            CHECK(percentiles(summary)[which] == slow_percentile(values, kShares[which]));
    }
}

TEST_CASE("an empty series is summarised as zeros") {
    CHECK(summarise({}).max == 0.0);
    CHECK(Histogram().summary().p999 == 0.0);
    CHECK(Histogram().summary().count == 0);
}

TEST_CASE("a histogram's percentiles are those of the series within its stated error, over all magnitudes") {
    std::mt19937_64 random(5);
    for (int round = 0; round < 60; ++round) {
        Histogram histogram;
        std::vector<double> values;
        const int bits = 1 + round;
        for (int item = 0; item < 400; ++item) {
            const auto value = static_cast<std::int64_t>(random() >> (64 - bits));
            histogram.record(value);
            values.push_back(static_cast<double>(value));
        }
        const auto exact = summarise(values);
        const auto found = histogram.summary();
        CAPTURE(bits);
        CHECK(found.count == exact.count);
        CHECK(found.max == exact.max);
        if (bits < 54) CHECK(found.mean == doctest::Approx(exact.mean));
        for (std::size_t which = 0; which < std::size(kShares); ++which) {
            const double wanted = percentiles(exact)[which];
            CHECK(std::abs(percentiles(found)[which] - wanted) <= wanted * kHistogramError * (1 + 1e-9));
        }
    }
}

TEST_CASE("small values are counted exactly, negative ones as zero, and units divide") {
    Histogram histogram;
    for (std::int64_t value = 0; value < 256; ++value) histogram.record(value);
    const auto summary = histogram.summary();
    CHECK(summary.p50 == 127.0);
    CHECK(summary.p999 == 255.0);
    histogram.clear();
    histogram.record(-5);
    CHECK(histogram.summary().max == 0.0);
    CHECK(histogram.count() == 1);
    histogram.clear();
    histogram.record(2'000'000);
    CHECK(histogram.summary(1e6).p50 == doctest::Approx(2.0).epsilon(kHistogramError));
    CHECK(histogram.summary(1e6).max == 2.0);
}

TEST_CASE("the largest value has a bucket") {
    Histogram histogram;
    histogram.record(std::numeric_limits<std::int64_t>::max());
    CHECK(histogram.summary().p50 == doctest::Approx(std::ldexp(1.0, 63)).epsilon(kHistogramError));
}

TEST_CASE("threads may record at once: nothing is lost") {
    constexpr int kThreads = 4;
    constexpr int kRecords = 20'000;
    Histogram histogram;
    std::vector<std::thread> threads;
    for (int thread = 0; thread < kThreads; ++thread) {
        threads.emplace_back([&histogram, thread] {
            for (int record = 0; record < kRecords; ++record) histogram.record(thread * kRecords + record);
        });
    }
    for (auto& thread : threads) thread.join();
    const auto summary = histogram.summary();
    CHECK(summary.count == kThreads * kRecords);
    CHECK(summary.max == kThreads * kRecords - 1);
    CHECK(summary.mean == doctest::Approx((kThreads * kRecords - 1) * 0.5));
}

}  // namespace
}  // namespace ridgeline::telemetry
