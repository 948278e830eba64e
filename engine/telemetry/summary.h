// What is said of a series of measurements: the mean and the tail.
#pragma once

#include <cstdint>
#include <span>

namespace ridgeline::telemetry {

// Percentiles are by nearest rank: the least value that at least this share of the values do not exceed. All
// zero for an empty series.
struct Summary {
    std::uint64_t count = 0;
    double mean = 0.0;
    double p50 = 0.0;
    double p95 = 0.0;
    double p99 = 0.0;
    double p999 = 0.0;
    double max = 0.0;
};

// The rank, from 1, of a percentile (share in [0, 1]) among `count` values, at least one.
std::uint64_t nearest_rank(double share, std::uint64_t count);

// Exact; sorts the values.
Summary summarise(std::span<double> values);

}  // namespace ridgeline::telemetry
