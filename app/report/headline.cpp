#include "ridgeline/app/report/headline.h"

#include <array>
#include <filesystem>
#include <limits>

#include "ridgeline/app/report/curve_chart.h"
#include "ridgeline/app/report/html_text.h"
#include "ridgeline/app/report/measures.h"
#include "ridgeline/app/report/quantity.h"

namespace ridgeline::app::report {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

double figure(const RunFolder& run, const char* name) {
    const double* value = run.summary.find(name);
    return value != nullptr ? *value : kUnknown;
}

// Of the frames that `name` counts.
double percent_of_frames(const RunFolder& run, const char* name) {
    const double frames = figure(run, "frames");
    return frames > 0.0 ? 100.0 * figure(run, name) / frames : kUnknown;
}

std::string figure_html(const std::string& value, const char* what, const std::string& more) {
    return "<div><dt>" + std::string(what) + "</dt><dd>" + value +
           (more.empty() ? "" : "<small>" + more + "</small>") + "</dd></div>";
}

std::string with_ratio(std::span<const RunFolder> runs, std::size_t index, const char* name) {
    return index == 0 ? std::string() : ratio_text(figure(runs[index], name), figure(runs[0], name));
}

// The last step of a path is what people call a dataset.
std::string dataset_name(const std::string& dataset) {
    std::filesystem::path path(dataset);
    if (!path.has_filename()) path = path.parent_path();
    return path.filename().string();
}

std::string about(const RunFolder& run) {
    std::string html;
    const auto add = [&html](const std::string& part) {
        if (!part.empty()) html += (html.empty() ? "" : " · ") + part;
    };
    const SummaryFile& summary = run.summary;
    add(isolated(dataset_name(summary.dataset)));
    if (const std::string* path = summary.find_option("path")) add("path " + isolated(*path));
    if (const std::string* size = summary.find_option("size")) add(isolated(*size));
    add(quantity(static_cast<double>(run.frames.frames()), Unit::frames));
    if (const double* seconds = summary.find("seconds"))
        add(quantity(*seconds, Unit::seconds) + " of wall time");
    if (!summary.gl_renderer.empty()) add(isolated(summary.gl_renderer));
    return html;
}

}  // namespace

std::string run_label(std::span<const RunFolder> runs, std::size_t index) {
    std::string name = isolated(runs[index].name);
    if (runs.size() == 1) return name;
    return "<span class=\"key " + colour_class(index) + "\"><b class=\"badge\">" + letter(index) + "</b>" +
           name + "</span>";
}

std::string headline(std::span<const RunFolder> runs, std::size_t index) {
    const RunFolder& run = runs[index];
    const auto measured = [&](const char* name, Unit unit) { return quantity(figure(run, name), unit); };
    std::string html = "<article class=\"card " + colour_class(index) + "\"><h2>" + run_label(runs, index) +
                       "</h2><p>" + about(run) + "</p><dl>";
    html += figure_html(measured("fps_mean", Unit::count), "frames a second",
                        with_ratio(runs, index, "fps_mean"));
    html += figure_html(measured("frame_ms.p50", Unit::milliseconds), "frame time, median",
                        with_ratio(runs, index, "frame_ms.p50"));
    html += figure_html(measured("frame_ms.p99", Unit::milliseconds), "99 of 100 frames within",
                        with_ratio(runs, index, "frame_ms.p99"));
    html += figure_html(measured("frame_ms.max", Unit::milliseconds), "slowest frame",
                        with_ratio(runs, index, "frame_ms.max"));
    html += figure_html(tick_text(figure(run, "per_frame.triangles"), Unit::count), "triangles a frame",
                        with_ratio(runs, index, "per_frame.triangles"));
    const auto share = [&](const char* name) {
        return quantity(percent_of_frames(run, name), Unit::percent);
    };
    html += figure_html(share("frames_with_missing_tiles"), "of frames lacked a tile", "");
    if (had_imagery(run))
        html += figure_html(share("frames_with_missing_imagery"), "of frames lacked imagery", "");
    html += figure_html(measured("peak_rss_bytes", Unit::bytes), "memory at most",
                        with_ratio(runs, index, "peak_rss_bytes"));
    return html + "</dl></article>\n";
}

}  // namespace ridgeline::app::report
