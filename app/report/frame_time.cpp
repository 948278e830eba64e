#include "ridgeline/app/report/frame_time.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "ridgeline/app/report/curve_path.h"
#include "ridgeline/app/report/film_strip.h"
#include "ridgeline/app/report/html_text.h"
#include "ridgeline/app/report/measure_chart.h"
#include "ridgeline/telemetry/summary.h"

namespace ridgeline::app::report {
namespace {

constexpr int kBins = 72;

struct Percentile {
    const char* name;
    double telemetry::Summary::*value;
};
constexpr std::array kPercentiles = {Percentile{"p50", &telemetry::Summary::p50},
                                     Percentile{"p95", &telemetry::Summary::p95},
                                     Percentile{"p99", &telemetry::Summary::p99}};

std::vector<double> frame_times(const RunFolder& run) {
    std::vector<double> times = values_of(frame_time_measure(), run.frames);
    std::erase_if(times, [](double time) { return std::isnan(time); });
    return times;
}

telemetry::Summary summary_of(const RunFolder& run) {
    std::vector<double> times = frame_times(run);
    return telemetry::summarise(times);
}

// --- the curve

std::string percentile_class(const Percentile& percentile, std::size_t run) {
    return std::string("percentile ") + percentile.name + " " + colour_class(run);
}

// Of one run: lines across the chart, named at their end unless they would cover one another.
void mark_across(const telemetry::Summary& summary, CurveChart& chart) {
    constexpr double kName_px = 15.0;
    double last_share = -1.0;
    for (const Percentile& percentile : kPercentiles) {
        const double value = summary.*percentile.value, share = chart.y.share(value);
        const bool room = share - last_share > kName_px / chart.height_px;
        chart.levels.push_back(
            {value, room ? percentile.name : std::string(), percentile_class(percentile, 0)});
        if (room) last_share = share;
    }
}

// Of several: a bar in the margin for each, from p50 to p99.
std::string marks_beside(std::span<const RunFolder> runs, const Axis& y) {
    std::string html;
    for (std::size_t run = 0; run < runs.size(); ++run) {
        const telemetry::Summary summary = summary_of(runs[run]);
        if (summary.count == 0) continue;
        const double low = y.share(summary.p50), high = std::min(y.share(summary.p99), 1.0);
        html += "<span class=\"spread run " + colour_class(run) + "\" style=\"--n:" + std::to_string(run) +
                ";bottom:" + percent_of(low) + ";height:" + percent_of(high - low) + "\"><i style=\"bottom:" +
                percent_of(high > low ? (std::min(y.share(summary.p95), 1.0) - low) / (high - low) : 0.0) +
                "\"></i><b>" + letter(run) + "</b></span>";
    }
    return html;
}

// What a display of sixty pictures a second leaves a frame, where that is on the chart and not at its foot.
void mark_budget(CurveChart& chart) {
    constexpr double kSixtieth_ms = 1000.0 / 60.0;
    if (const double share = chart.y.share(kSixtieth_ms); share > 0.1 && share < 0.97)
        chart.levels.push_back({kSixtieth_ms, "60 a second", "budget"});
}

// --- the histogram

struct Bins {
    std::size_t run;
    std::vector<double> counts;
};

std::vector<Bins> binned(std::span<const RunFolder> runs, const Axis& x) {
    std::vector<Bins> all;
    for (std::size_t run = 0; run < runs.size(); ++run) {
        Bins bins{run, std::vector<double>(kBins, 0.0)};
        for (const double time : frame_times(runs[run])) {
            if (time <= 0.0) continue;
            const double bin = std::clamp(std::floor(x.share(time) * kBins), 0.0, kBins - 1.0);
            ++bins.counts[static_cast<std::size_t>(bin)];
        }
        all.push_back(std::move(bins));
    }
    return all;
}

// Counts are drawn from half of one, so that a single frame stands above the foot.
constexpr double kFoot = 0.5;

Axis count_axis(const std::vector<Bins>& all) {
    double most = 1.0;
    for (const Bins& bins : all)
        most = std::max(most, *std::max_element(bins.counts.begin(), bins.counts.end()));
    Axis axis{kFoot, most * 1.4, {}, true};
    for (int power = 0; std::pow(10.0, power) <= axis.last; ++power)
        axis.ticks.push_back(std::pow(10.0, power));
    return axis;
}

int height_of(double count, const Axis& y) {
    return static_cast<int>(std::lround((1.0 - y.share(count)) * kHeight));
}

// The outline of each stretch of bins that hold frames.
std::string steps(const Bins& bins, const Axis& y) {
    const std::string foot = std::to_string(kHeight);
    std::string path;
    bool inside = false;
    for (std::size_t bin = 0; bin < bins.counts.size(); ++bin) {
        if (bins.counts[bin] > 0.0) {
            if (!inside) path += "M" + std::to_string(bin) + " " + foot;
            path += "V" + std::to_string(height_of(bins.counts[bin], y)) + "h1";
        } else if (inside) {
            path += "V" + foot;
        }
        inside = bins.counts[bin] > 0.0;
    }
    if (inside) path += "V" + foot;
    return "<g class=\"run " + colour_class(bins.run) + "\"><path class=\"bars\" d=\"" + path + "\"/></g>";
}

std::string histogram_marks(std::span<const RunFolder> runs, const Axis& x) {
    std::string html;
    for (std::size_t run = 0; run < runs.size(); ++run) {
        const telemetry::Summary summary = summary_of(runs[run]);
        for (const Percentile& percentile : kPercentiles) {
            const double value = summary.*percentile.value;
            if (!(value > 0.0)) continue;
            html += "<span class=\"run mark " + percentile_class(percentile, run) +
                    "\" style=\"left:" + percent_of(x.share(value)) + "\">" +
                    (runs.size() == 1 ? percentile.name : "") + "</span>";
        }
    }
    return html;
}

std::string histogram_description(std::span<const RunFolder> runs) {
    std::string text = "How many frames took how long.";
    for (const RunFolder& run : runs) {
        const telemetry::Summary summary = summary_of(run);
        text += " " + run.name + ": " + std::to_string(summary.count) + " frames, half of them within " +
                quantity(summary.p50, Unit::milliseconds) + ", 95 of 100 within " +
                quantity(summary.p95, Unit::milliseconds) + ", 99 of 100 within " +
                quantity(summary.p99, Unit::milliseconds) + ", the slowest " +
                quantity(summary.max, Unit::milliseconds) + ".";
    }
    return text;
}

}  // namespace

std::string frame_time_chart(std::span<const RunFolder> runs, const WalkAxis& walk) {
    if (shown(frame_time_measure(), runs) != Shown::chart) return {};
    CurveChart chart = chart_of(frame_time_measure(), runs, walk);
    chart.height_px = 260;
    chart.style = "wide frames";
    chart.above = film_strips(runs, walk);
    mark_budget(chart);
    if (runs.size() == 1) {
        mark_across(summary_of(runs.front()), chart);
    } else {
        chart.beside = marks_beside(runs, chart.y);
        chart.note += "; bars at the right from p50 to p99, with a notch at p95";
    }
    return html(chart, walk);
}

std::string frame_time_histogram(std::span<const RunFolder> runs) {
    double least = 0.0, most = 0.0;
    for (const RunFolder& run : runs)
        for (const double time : frame_times(run)) {
            if (time <= 0.0) continue;
            least = least == 0.0 ? time : std::min(least, time);
            most = std::max(most, time);
        }
    if (least == 0.0) return {};
    const Axis x = logarithmic_axis(least, most);
    const std::vector<Bins> all = binned(runs, x);
    const Axis y = count_axis(all);
    std::string svg = "<svg viewBox=\"0 0 " + std::to_string(kBins) + " " + std::to_string(kHeight) +
                      "\" preserveAspectRatio=\"none\" aria-hidden=\"true\">" + grid_lines(x, y, kBins);
    for (auto bins = all.rbegin(); bins != all.rend(); ++bins) svg += steps(*bins, y);
    return "<figure class=\"chart wide\"><figcaption><h3>Frame times, counted <span "
           "class=\"unit\">ms</span></h3>"
           "<p>frames, on a logarithmic scale" +
           std::string(runs.size() > 1 ? "; p50 solid, p95 dashed, p99 dotted" : "") +
           "</p></figcaption><div class=\"plot histogram\" role=\"img\" aria-label=\"" +
           escaped(histogram_description(runs)) + "\" style=\"--h:150px\"><div class=\"area\">" + svg +
           "</svg>" + ticks_at_left(y, Unit::count) + ticks_at_foot(x, Unit::milliseconds) +
           histogram_marks(runs, x) + "</div></div></figure>\n";
}

}  // namespace ridgeline::app::report
