#include "ridgeline/app/report/figure_tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "ridgeline/app/report/headline.h"
#include "ridgeline/app/report/quantity.h"

namespace ridgeline::app::report {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

struct Figure {
    const char* name;  // in summary.json
    const char* title;
    Unit unit;
};

constexpr std::array kSeries = {
    Figure{"frame_ms", "Frame time", Unit::milliseconds},
    Figure{"selection_ms", "Selection", Unit::milliseconds}, Figure{"gpu_ms", "GPU", Unit::milliseconds},
    Figure{"request_to_ready_ms", "Tile: from request to ready", Unit::milliseconds},
    Figure{"request_to_drawn_frames", "Tile: from request to drawn", Unit::frames}};

struct Statistic {
    const char* name;
    const char* title;
};
constexpr std::array kStatistics = {Statistic{"mean", "mean"},  Statistic{"p50", "p50"},
                                    Statistic{"p95", "p95"},    Statistic{"p99", "p99"},
                                    Statistic{"p999", "p99.9"}, Statistic{"max", "most"}};

constexpr std::array kCounts = {
    Figure{"frames", "Frames", Unit::count},
    Figure{"seconds", "Wall time", Unit::seconds},
    Figure{"fps_mean", "Frames a second, mean", Unit::count},
    Figure{"per_frame.triangles", "Triangles a frame", Unit::count},
    Figure{"per_frame.draws", "Draw calls a frame", Unit::count},
    Figure{"per_frame.nodes_visited", "Nodes visited a frame", Unit::count},
    Figure{"per_frame.nodes_drawn", "Nodes drawn a frame", Unit::count},
    Figure{"per_frame.nodes_frustum_culled", "Nodes culled by the frustum a frame", Unit::count},
    Figure{"per_frame.nodes_horizon_culled", "Nodes culled by the horizon a frame", Unit::count},
    Figure{"per_frame.cpu_render_ms", "CPU time of the render thread a frame", Unit::milliseconds},
    Figure{"per_frame.heap_allocations", "Heap allocations a frame", Unit::count},
    Figure{"per_frame.bytes_read", "Read a frame", Unit::bytes},
    Figure{"per_frame.bytes_uploaded", "Uploaded a frame", Unit::bytes},
    Figure{"tiles.requested", "Tiles requested", Unit::count},
    Figure{"tiles.loaded", "Tiles loaded", Unit::count},
    Figure{"tiles.cancelled", "Tiles cancelled", Unit::count},
    Figure{"tiles.failed", "Reads that failed", Unit::count},
    Figure{"tiles.retried", "Reads tried again", Unit::count},
    Figure{"tiles.evicted", "Tiles evicted", Unit::count},
    Figure{"frames_with_missing_tiles", "Frames that lacked a tile", Unit::count},
    Figure{"frames_with_missing_heights", "Frames that lacked heights of the disc", Unit::count},
    Figure{"frames_with_missing_imagery", "Frames that lacked imagery", Unit::count},
    Figure{"peak_rss_bytes", "Memory, at most", Unit::bytes},
    Figure{"ram_cache_bytes_max", "RAM cache, at most", Unit::bytes},
    Figure{"gpu_cache_bytes_max", "GPU cache, at most", Unit::bytes}};

double figure(const RunFolder& run, const std::string& name) {
    const double* value = run.summary.find(name);
    return value != nullptr ? *value : kUnknown;
}

bool any_has(std::span<const RunFolder> runs, const std::string& name) {
    return std::any_of(runs.begin(), runs.end(),
                       [&](const RunFolder& run) { return run.summary.find(name) != nullptr; });
}

// Within this the run is called as good as the first, and its ratio is set back.
constexpr double kAlike = 0.02;

// The first run's has room for a ratio too, so that numbers stand in line.
std::string cell(std::span<const RunFolder> runs, std::size_t run, const std::string& name, Unit unit) {
    const double value = figure(runs[run], name), first = figure(runs[0], name);
    std::string html = "<td>" + quantity(value, unit == Unit::frames ? Unit::count : unit);
    if (runs.size() == 1) return html + "</td>";
    const bool alike = value == first || std::abs(value / first - 1.0) <= kAlike;
    return html + "<small" + (alike ? " class=\"alike\"" : "") + ">" +
           (run == 0 ? "" : ratio_text(value, first)) + "</small></td>";
}

std::string percentile_row(std::span<const RunFolder> runs, const Figure& series, std::size_t run) {
    std::string html = "<tr>";
    if (run == 0)
        html += "<th scope=\"rowgroup\" rowspan=\"" + std::to_string(runs.size()) + "\">" + series.title +
                (series.unit == Unit::frames ? " <span class=\"unit\">frames</span>" : "") + "</th>";
    if (runs.size() > 1) html += "<th scope=\"row\">" + run_label(runs, run) + "</th>";
    for (const Statistic& statistic : kStatistics)
        html += cell(runs, run, std::string(series.name) + "." + statistic.name, series.unit);
    return html + "</tr>";
}

std::string count_row(std::span<const RunFolder> runs, const Figure& count) {
    std::string html = "<tr><th scope=\"row\">" + std::string(count.title) + "</th>";
    for (std::size_t run = 0; run < runs.size(); ++run) html += cell(runs, run, count.name, count.unit);
    return html + "</tr>";
}

}  // namespace

std::string percentiles_table(std::span<const RunFolder> runs) {
    std::string html = "<div class=\"table\"><table><caption>Percentiles</caption><thead><tr><th></th>";
    if (runs.size() > 1) html += "<th scope=\"col\">run</th>";
    for (const Statistic& statistic : kStatistics)
        html += "<th scope=\"col\">" + std::string(statistic.title) + "</th>";
    html += "</tr></thead>";
    for (const Figure& series : kSeries) {
        if (!any_has(runs, std::string(series.name) + ".max")) continue;
        html += "<tbody>";
        for (std::size_t run = 0; run < runs.size(); ++run) html += percentile_row(runs, series, run);
        html += "</tbody>";
    }
    return html + "</table></div>\n";
}

std::string counts_table(std::span<const RunFolder> runs) {
    std::string html =
        "<div class=\"table\"><table><caption>Everything counted</caption><thead><tr><th></th>";
    for (std::size_t run = 0; run < runs.size(); ++run)
        html += "<th scope=\"col\">" + run_label(runs, run) + "</th>";
    html += "</tr></thead><tbody>";
    for (const Figure& count : kCounts)
        if (any_has(runs, count.name)) html += count_row(runs, count);
    return html + "</tbody></table></div>\n";
}

}  // namespace ridgeline::app::report
