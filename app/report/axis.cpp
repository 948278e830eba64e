#include "ridgeline/app/report/axis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace ridgeline::app::report {
namespace {

constexpr std::array kSteps = {1.0, 2.0, 5.0};

// The least round step that is no less than `least`, above 0.
double round_step(double least, Unit unit) {
    if (unit == Unit::bytes) return std::max(1.0, std::exp2(std::ceil(std::log2(least))));
    const double power = std::pow(10.0, std::floor(std::log10(least)));
    for (const double step : kSteps)
        if (step * power >= least) return step * power;
    return 10.0 * power;
}

// What is counted has no ticks between whole numbers.
bool is_counted(Unit unit) { return unit == Unit::count || unit == Unit::frames || unit == Unit::bytes; }

// 1, 2 or 5 times a power of ten, by its place among these.
double round_value(int place) {
    const int power = static_cast<int>(std::floor(place / 3.0));
    return kSteps[static_cast<std::size_t>(place - 3 * power)] * std::pow(10.0, power);
}

int place_below(double value) {
    // One lower than the logarithm says, which may be rounded up.
    int place = 3 * static_cast<int>(std::floor(std::log10(value))) - 1;
    while (round_value(place + 1) <= value) ++place;
    return place;
}

}  // namespace

double Axis::share(double value) const {
    if (logarithmic) return std::log(value / first) / std::log(last / first);
    return (value - first) / (last - first);
}

Axis linear_axis(double first, double last, Unit unit, int most_ticks) {
    // Ends so close that they are one point of the chart, or so large that steps between them would not
    // count.
    const double least_span = 1e-6 * std::max(std::abs(first), std::abs(last));
    if (!(last - first > least_span)) last = first + std::max(1.0, least_span);
    Axis axis{first, last, {}, false};
    double step = round_step((last - first) / most_ticks, unit);
    if (is_counted(unit)) step = std::max(step, 1.0);
    const auto from = static_cast<std::int64_t>(std::ceil(first / step));
    const auto to = static_cast<std::int64_t>(std::floor(last / step));
    for (std::int64_t at = from; at <= to; ++at) axis.ticks.push_back(static_cast<double>(at) * step);
    return axis;
}

Axis logarithmic_axis(double least, double most) {
    constexpr double kWidest = 1e6;
    const int from = place_below(std::max(least, most / kWidest));
    int to = place_below(most);
    if (round_value(to) < most || to == from) ++to;
    Axis axis{round_value(from), round_value(to), {}, true};
    constexpr int kMostTicks = 12;
    // Of a wide axis, powers of ten alone.
    for (int place = from; place <= to; ++place)
        if (to - from < kMostTicks || place % 3 == 0) axis.ticks.push_back(round_value(place));
    return axis;
}

}  // namespace ridgeline::app::report
