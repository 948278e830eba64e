// A histogram of non-negative integers (nanoseconds, frames, bytes) of any size, for series too long or too
// scattered over threads to keep.
//
// Recording is wait-free, allocates nothing and may be done by any number of threads at once. Buckets are
// linear within each power of two: values below 256 are counted exactly, larger ones in buckets 1/128 of
// their lower end wide at most. Percentiles name the middle of a bucket, so they are off by 0.4 % at most;
// mean and maximum are exact.
#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "ridgeline/telemetry/summary.h"

namespace ridgeline::telemetry {

class Histogram {
  public:
    // Negative values, which clocks of different threads may yield, count as zero.
    void record(std::int64_t value);

    // Of all that was recorded before; `unit` is what one is divided by (1e6: nanoseconds to milliseconds).
    Summary summary(double unit = 1.0) const;
    std::uint64_t count() const { return count_.load(std::memory_order_relaxed); }
    void clear();

  private:
    // Buckets in each power of two, as bits.
    static constexpr int kBucketBits = 7;
    static constexpr std::size_t kLinear = std::size_t{2} << kBucketBits;
    static constexpr std::size_t kBuckets = kLinear + ((63 - kBucketBits - 1) << kBucketBits);

    static std::size_t bucket_of(std::uint64_t value);
    static double middle_of(std::size_t bucket);
    double percentile(double share, std::uint64_t count) const;

    std::array<std::atomic<std::uint64_t>, kBuckets> buckets_{};
    std::atomic<std::uint64_t> count_{0};
    std::atomic<std::uint64_t> sum_{0};
    std::atomic<std::uint64_t> max_{0};
};

}  // namespace ridgeline::telemetry
