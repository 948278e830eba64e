#include "ridgeline/app/report/page.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <vector>

#include "ridgeline/app/report/cpu_bars.h"
#include "ridgeline/app/report/figure_tables.h"
#include "ridgeline/app/report/frame_time.h"
#include "ridgeline/app/report/headline.h"
#include "ridgeline/app/report/html_text.h"
#include "ridgeline/app/report/measure_chart.h"
#include "ridgeline/app/report/options_table.h"
#include "ridgeline/app/report/page_assets.h"
#include "ridgeline/base/contract.h"

namespace ridgeline::app::report {
namespace {

using Runs = std::span<const RunFolder>;

struct SectionText {
    Section section;
    const char* title;
    const char* note;  // HTML
};
constexpr std::array kSections = {
    SectionText{Section::time, "Where the time goes",
                "CPU times are the threads' own; what the GPU took arrives some frames late, and of the last "
                "frames never."},
    SectionText{Section::drawn, "What is drawn",
                "Nodes are visited from the coarsest down; those out of view and those behind mountains end "
                "the descent."},
    SectionText{Section::paging, "Paging", "Caches have a fixed size; a dashed line is what they may hold."},
    SectionText{Section::ground, "Imagery and tiles over the ground",
                "Which tiles are wanted follows from what a picture some frames ago showed of the ground."},
    SectionText{Section::eye, "The eye and the heap",
                "A walk that has settled lifts no eye and allocates nothing."}};

// Nothing may be fetched, whatever a name in the telemetry says.
constexpr const char* kPolicy =
    "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'";

std::string subject(Runs runs) {
    std::vector<std::string> names;
    for (const RunFolder& run : runs) {
        std::filesystem::path path(run.summary.dataset);
        if (!path.has_filename()) path = path.parent_path();
        const std::string name = path.filename().empty() ? "a walk" : path.filename().string();
        if (names.empty() || names.back() != name) names.push_back(name);
    }
    std::string text = names.front();
    for (std::size_t i = 1; i < names.size(); ++i) text += ", " + names[i];
    return text;
}

std::string head(Runs runs) {
    return std::string(kPageOpening) + "<meta http-equiv=\"Content-Security-Policy\" content=\"" +
           std::string(kPolicy) +
           "\"/>\n"
           "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
           "<meta name=\"color-scheme\" content=\"light dark\"/>\n<title>" +
           escaped(subject(runs)) + " – Ridgeline walk report</title>\n<style>" + std::string(kPageStyle) +
           "</style>\n</head>\n";
}

std::string attribute(const char* name, double value) {
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), " data-%s=\"%.9g\"", name, value);
    return text.data();
}

std::string main_tag(const std::optional<WalkAxis>& walk) {
    if (!walk) return "<main data-columns=\"1\">\n";
    return "<main" + attribute("columns", walk->columns) + attribute("first", walk->axis.first) +
           attribute("last", walk->axis.last) + " data-unit=\"" + unit_name(walk->unit) + "\">\n";
}

std::string opening(Runs runs) {
    std::string html =
        "<header><p class=\"eyebrow\">Ridgeline walk report</p><h1>" + isolated(subject(runs)) + "</h1>";
    if (runs.size() > 1)
        html += "<p class=\"lead\">" + std::to_string(runs.size()) +
                " runs side by side; × compares with the first, " + run_label(runs, 0) + ".</p>";
    html += "</header>\n<div class=\"cards\">\n";
    for (std::size_t run = 0; run < runs.size(); ++run) html += headline(runs, run);
    return html + "</div>\n";
}

// Stays in sight while the charts scroll by.
std::string keys(Runs runs) {
    if (runs.size() < 2) return {};
    std::string html = "<div class=\"keys\">";
    for (std::size_t run = 0; run < runs.size(); ++run) html += run_label(runs, run);
    return html + "</div>\n";
}

std::string walk_section(Runs runs, const std::optional<WalkAxis>& walk) {
    const std::string chart = walk ? frame_time_chart(runs, *walk) : std::string();
    std::string html = "<section><h2>The walk</h2>";
    if (!walk)
        html += "<p>No frames were recorded.</p>";
    else if (chart.empty())
        html += "<p>Frame times were not recorded.</p>";
    else
        html +=
            "<p>Curves are the median of the frames that share a column of the picture; the band around them "
            "reaches from the least to the greatest, so no frame is lost.</p>";
    return html + "<div class=\"grid\">" + chart + frame_time_histogram(runs) + "</div></section>\n";
}

std::string titles(const std::vector<std::string>& list) {
    std::string text;
    for (const std::string& title : list) text += (text.empty() ? "" : ", ") + title;
    return text;
}

// The charts of a section; what never was anything but 0, and what nobody recorded, as a line each.
std::string section_html(const SectionText& section, Runs runs, const WalkAxis& walk) {
    std::string charts = section.section == Section::time ? cpu_by_thread(runs) : std::string();
    std::vector<std::string> zero, absent;
    for (const Measure& measure : measures()) {
        if (measure.section != section.section) continue;
        const Shown how = shown(measure, runs);
        if (how == Shown::chart) charts += html(chart_of(measure, runs, walk), walk);
        if (how == Shown::zero) zero.emplace_back(measure.title);
        if (how == Shown::absent) absent.emplace_back(measure.title);
    }
    std::string html = "<section><h2>" + std::string(section.title) + "</h2><p>" + section.note + "</p>";
    if (!charts.empty()) html += "<div class=\"grid\">" + charts + "</div>";
    if (!zero.empty()) html += "<p class=\"quiet\">0 in every frame: " + titles(zero) + ".</p>";
    if (!absent.empty()) html += "<p class=\"quiet\">Not recorded: " + titles(absent) + ".</p>";
    return html + "</section>\n";
}

bool has_section(Section section, Runs runs) {
    return section != Section::ground || std::any_of(runs.begin(), runs.end(), had_ground_tiles);
}

std::string numbers(Runs runs) {
    return "<section><h2>In numbers</h2><p>Percentiles are by nearest rank: the least value that this share "
           "of the frames do not exceed.</p>" +
           percentiles_table(runs) + counts_table(runs) + options_table(runs) + "</section>\n";
}

std::string closing(Runs runs) {
    std::string html = "<footer>";
    for (const RunFolder& run : runs)
        for (const std::string& why : run.thumbnails.left_out)
            html += "<p>A picture is left out: " + isolated(why) + "</p>";
    return html +
           "<p>Made by ridgeline report. Nothing in this page is fetched from elsewhere.</p></footer>\n";
}

}  // namespace

std::string page_of(Runs runs) {
    RIDGELINE_CHECK(!runs.empty() && runs.size() <= kMostRuns);
    const std::optional<WalkAxis> walk = walk_axis(runs);
    std::string page = head(runs) + "<body class=\"" + (runs.size() > 1 ? "several" : "one") +
                       "\" style=\"--runs:" + std::to_string(runs.size()) + "\">\n" + main_tag(walk) +
                       opening(runs) + differing_options(runs) + keys(runs);
    page += walk_section(runs, walk);
    if (walk)
        for (const SectionText& section : kSections)
            if (has_section(section.section, runs)) page += section_html(section, runs, *walk);
    page += numbers(runs) + closing(runs) + "</main>\n<script>" + std::string(kPageScript) +
            "</script>\n</body>\n</html>\n";
    return page;
}

}  // namespace ridgeline::app::report
