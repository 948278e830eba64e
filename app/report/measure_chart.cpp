#include "ridgeline/app/report/measure_chart.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ridgeline/telemetry/summary.h"

namespace ridgeline::app::report {
namespace {

// Values this many times above what most frames need are marked at the edge of the chart, which they would
// flatten.
constexpr double kFarAbove = 2.5;
// Of the values, those that the axis must hold; and the room above the greatest of them.
constexpr double kUsualShare = 0.99;
constexpr double kRoomAboveUsual = 1.5;
constexpr double kRoomAbove = 1.06;
constexpr int kMostTicks = 4;

std::optional<double> capacity_of(const Measure& measure, const RunFolder& run) {
    const std::string* text =
        measure.capacity != nullptr ? run.summary.find_option(measure.capacity) : nullptr;
    double value = 0.0;
    if (text == nullptr) return std::nullopt;
    const auto [end, status] = std::from_chars(text->data(), text->data() + text->size(), value);
    if (status != std::errc() || end != text->data() + text->size() || !(value > 0.0 && value < 1e18))
        return std::nullopt;
    return value;
}

telemetry::Summary summary_of(std::vector<double> values) {
    std::erase_if(values, [](double value) { return std::isnan(value); });
    return telemetry::summarise(values);
}

// The greatest value that the axis must reach for one run.
double top_of(const Measure& measure, const std::vector<double>& values) {
    std::vector<double> known = values;
    std::erase_if(known, [](double value) { return std::isnan(value); });
    if (known.empty()) return 0.0;
    std::sort(known.begin(), known.end());
    const double usual = kRoomAboveUsual * known[telemetry::nearest_rank(kUsualShare, known.size()) - 1];
    return measure.top == Measure::Top::usual && usual > 0.0 && known.back() > kFarAbove * usual
               ? usual
               : known.back();
}

double axis_top(const Measure& measure, std::span<const RunFolder> runs) {
    double top = 0.0;
    for (const RunFolder& run : runs) {
        top = std::max(top, top_of(measure, values_of(measure, run.frames)));
        top = std::max(top, capacity_of(measure, run).value_or(0.0));
        if (measure.same_axis_as == nullptr) continue;
        Measure other = measure;
        other.column = measure.same_axis_as;
        top = std::max(top, top_of(measure, values_of(other, run.frames)));
    }
    return top > 0.0 ? top : 1.0;
}

// The least value of any run, with some room below; 0 where there is none.
double axis_foot(const Measure& measure, std::span<const RunFolder> runs, double most) {
    double least = most;
    for (const RunFolder& run : runs)
        for (const double value : values_of(measure, run.frames))
            least = std::min(least, std::isnan(value) ? most : value);
    return least - (kRoomAbove - 1.0) * (most - least);
}

Axis axis_of(const Measure& measure, std::span<const RunFolder> runs) {
    const double top = axis_top(measure, runs);
    if (measure.foot == Measure::Foot::zero)
        return linear_axis(0.0, top * kRoomAbove, measure.unit, kMostTicks);
    const double foot = axis_foot(measure, runs, top);
    return linear_axis(foot, top + (kRoomAbove - 1.0) * (top - foot), measure.unit, kMostTicks);
}

// One line where all runs have the same capacity, else one a run in its colour.
std::vector<Level> capacities(const Measure& measure, std::span<const RunFolder> runs) {
    std::vector<Level> levels;
    for (std::size_t run = 0; run < runs.size(); ++run) {
        const auto capacity = capacity_of(measure, runs[run]);
        const auto same = [&](const Level& level) { return level.value == capacity; };
        if (!capacity) continue;
        if (const auto found = std::find_if(levels.begin(), levels.end(), same); found != levels.end())
            found->style = "capacity";
        else
            levels.push_back({*capacity, "", "capacity " + colour_class(run)});
    }
    if (levels.size() == 1) levels.front().style = "capacity";
    return levels;
}

// "at most 16.0 MiB of 256.0 MiB (6.2 %)", of the fullest run.
std::string fill_text(const Measure& measure, std::span<const RunFolder> runs) {
    double share = -1.0;
    std::string text;
    for (const RunFolder& run : runs) {
        const auto capacity = capacity_of(measure, run);
        const double most = summary_of(values_of(measure, run.frames)).max;
        if (!capacity || most / *capacity <= share) continue;
        share = most / *capacity;
        text = "; at most " + quantity(most, measure.unit) + " of " + quantity(*capacity, measure.unit) +
               ", " + quantity(100.0 * share, Unit::percent);
    }
    return text;
}

// "; ▴ 2 frames above the scale, up to 496 ms".
std::string above_text(const Measure& measure, std::span<const RunFolder> runs, double top) {
    std::size_t above = 0;
    double most = 0.0;
    for (const RunFolder& run : runs)
        for (const double value : values_of(measure, run.frames)) {
            above += value > top ? 1 : 0;
            most = value > most ? value : most;
        }
    if (above == 0) return {};
    return "; <span class=\"over\">▲</span> " + std::to_string(above) + (above == 1 ? " frame" : " frames") +
           " above the scale, up to " + quantity(most, measure.unit);
}

std::string description_of(const Measure& measure, std::span<const RunFolder> runs) {
    std::string text = std::string(measure.title) + " over the walk.";
    for (const RunFolder& run : runs) {
        const telemetry::Summary summary = summary_of(values_of(measure, run.frames));
        text += " " + run.name + ": ";
        if (summary.count == 0)
            text += "not recorded.";
        else if (measure.count == Measure::Count::total)
            text += quantity(summary.max, measure.unit) + " in all.";
        else
            text += "median " + quantity(summary.p50, measure.unit) + ", 99 of 100 frames at most " +
                    quantity(summary.p99, measure.unit) + ", most " + quantity(summary.max, measure.unit) +
                    ".";
    }
    return text;
}

}  // namespace

CurveChart chart_of(const Measure& measure, std::span<const RunFolder> runs, const WalkAxis& walk) {
    CurveChart chart{.title = measure.title,
                     .note = measure.note,
                     .description = description_of(measure, runs),
                     .unit = measure.unit,
                     .y = axis_of(measure, runs),
                     .curves = {},
                     .levels = capacities(measure, runs),
                     .above = {},
                     .beside = {},
                     .style = measure.width == Measure::Width::full ? "wide" : ""};
    chart.note += fill_text(measure, runs) + above_text(measure, runs, chart.y.last);
    const ColumnGrid grid{walk.axis.first, walk.axis.last, walk.columns};
    for (std::size_t run = 0; run < runs.size(); ++run) {
        const std::vector<double> values = values_of(measure, runs[run].frames);
        if (values.empty()) continue;
        Curve curve{run, decimated(places_on(walk, runs[run].frames), values, grid)};
        if (!curve.columns.empty()) chart.curves.push_back(std::move(curve));
    }
    return chart;
}

}  // namespace ridgeline::app::report
