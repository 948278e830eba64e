// Whether a measure rises over a run: its slope, and how far chance alone may have brought that.
//
// What is measured of a running program one second is much like the second before, so the samples' own
// scatter would make any slope look sure. They are averaged over a few long parts, each of which is nearly
// independent of the others, and a line is fitted to those. Where the program goes the same round again and
// again, what belongs to a place of the round is taken off first, or it would hide what grows. Plain values;
// any thread.
#pragma once

#include <span>

namespace ridgeline::telemetry {

struct TrendSample {
    double time_s = 0.0;  // rises
    double value = 0.0;
    double rounds = 0.0;  // gone since any moment; 0 in all samples where there are none
};

struct Trend {
    static constexpr int kParts = 12;
    // Of Student's distribution with two degrees fewer than there are parts: a level measure is more errors
    // than these from level once in a hundred runs, either way.
    static constexpr double kSureErrors = 3.169;

    double mean = 0.0;
    double per_hour = 0.0;
    double error_per_hour = 0.0;  // standard error

    // A slope steeper than this would have been told from none.
    double least_told_per_hour() const { return kSureErrors * error_per_hour; }
    bool rises() const { return per_hour > least_told_per_hour(); }
    bool falls() const { return -per_hour > least_told_per_hour(); }
};

// samples: at least kParts; what is over when they are divided evenly is left out at the front. resolution: a
// value may be wrong by so much either way; the error knows of it.
Trend trend_of(std::span<const TrendSample> samples, double resolution = 0.0);

}  // namespace ridgeline::telemetry
