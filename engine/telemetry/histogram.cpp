// Log-linear buckets, as in Tene's HdrHistogram (hdrhistogram.org), of one fixed precision and for all of 63
// bits, so that there is nothing to configure and nothing out of range.
#include "ridgeline/telemetry/histogram.h"

#include <algorithm>

namespace ridgeline::telemetry {

// Values of b bits, b beyond the linear part, are shifted right until kBucketBits + 1 bits are left; the top
// bit of these is always set, so each such b has 2^kBucketBits buckets.
std::size_t Histogram::bucket_of(std::uint64_t value) {
    if (value < kLinear) return value;
    const int shift = std::bit_width(value) - (kBucketBits + 1);
    return (static_cast<std::size_t>(shift) << kBucketBits) + static_cast<std::size_t>(value >> shift);
}

double Histogram::middle_of(std::size_t bucket) {
    if (bucket < kLinear) return static_cast<double>(bucket);
    const auto shift = (bucket >> kBucketBits) - 1;
    const auto first = (bucket - (shift << kBucketBits)) << shift;
    return static_cast<double>(first) + static_cast<double>((std::uint64_t{1} << shift) - 1) * 0.5;
}

void Histogram::record(std::int64_t value) {
    const auto counted = static_cast<std::uint64_t>(std::max<std::int64_t>(value, 0));
    buckets_[bucket_of(counted)].fetch_add(1, std::memory_order_relaxed);
    count_.fetch_add(1, std::memory_order_relaxed);
    sum_.fetch_add(counted, std::memory_order_relaxed);
    auto max = max_.load(std::memory_order_relaxed);
    while (max < counted && !max_.compare_exchange_weak(max, counted, std::memory_order_relaxed)) {
    }
}

double Histogram::percentile(double share, std::uint64_t count) const {
    const auto max = static_cast<double>(max_.load(std::memory_order_relaxed));
    const auto rank = nearest_rank(share, count);
    std::uint64_t below = 0;
    for (std::size_t bucket = 0; bucket < kBuckets; ++bucket) {
        below += buckets_[bucket].load(std::memory_order_relaxed);
        if (below >= rank) return std::min(middle_of(bucket), max);
    }
    return max;
}

Summary Histogram::summary(double unit) const {
    const auto recorded = count();
    if (recorded == 0) return {};
    const auto in_unit = [unit](double value) { return value / unit; };
    return {.count = recorded,
            .mean = in_unit(static_cast<double>(sum_.load(std::memory_order_relaxed)) /
                            static_cast<double>(recorded)),
            .p50 = in_unit(percentile(0.50, recorded)),
            .p95 = in_unit(percentile(0.95, recorded)),
            .p99 = in_unit(percentile(0.99, recorded)),
            .p999 = in_unit(percentile(0.999, recorded)),
            .max = in_unit(static_cast<double>(max_.load(std::memory_order_relaxed)))};
}

void Histogram::clear() {
    for (auto& bucket : buckets_) bucket.store(0, std::memory_order_relaxed);
    count_.store(0, std::memory_order_relaxed);
    sum_.store(0, std::memory_order_relaxed);
    max_.store(0, std::memory_order_relaxed);
}

}  // namespace ridgeline::telemetry
