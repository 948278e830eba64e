#include "ridgeline/app/report/options_table.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <set>

#include "ridgeline/app/report/headline.h"
#include "ridgeline/app/report/html_text.h"
#include "ridgeline/app/report/quantity.h"

namespace ridgeline::app::report {
namespace {

// What is no option of the command line and tells runs apart all the same.
constexpr const char* kDataset = "dataset";
constexpr const char* kRenderer = "OpenGL renderer";

std::optional<std::string> value_of(const RunFolder& run, const std::string& name) {
    if (name == kDataset) return run.summary.dataset;
    if (name == kRenderer) return run.summary.gl_renderer;
    if (const std::string* value = run.summary.find_option(name)) return *value;
    return std::nullopt;
}

std::vector<std::string> names_of(std::span<const RunFolder> runs) {
    std::set<std::string> names;
    for (const RunFolder& run : runs)
        for (const auto& [name, value] : run.summary.options) names.insert(name);
    std::vector<std::string> all = {kDataset, kRenderer};
    all.insert(all.end(), names.begin(), names.end());
    return all;
}

// Caches are written in bytes, and read in MiB.
std::string shown_value(const std::string& name, const std::optional<std::string>& value) {
    if (!value) return "<span class=\"unit\">not given</span>";
    double bytes = 0.0;
    const auto [end, status] = std::from_chars(value->data(), value->data() + value->size(), bytes);
    if (name.ends_with("-cache") && status == std::errc() && end == value->data() + value->size())
        return quantity(bytes, Unit::bytes);
    return isolated(*value);
}

std::string table(std::span<const RunFolder> runs, const std::vector<std::string>& names,
                  const char* caption) {
    std::string html = "<div class=\"table\"><table class=\"words\"><caption>" + std::string(caption) +
                       "</caption><thead><tr><th></th>";
    for (std::size_t run = 0; run < runs.size(); ++run)
        html += "<th scope=\"col\">" + run_label(runs, run) + "</th>";
    html += "</tr></thead><tbody>";
    for (const std::string& name : names) {
        html += "<tr><th scope=\"row\">" + isolated(name) + "</th>";
        for (const RunFolder& run : runs) html += "<td>" + shown_value(name, value_of(run, name)) + "</td>";
        html += "</tr>";
    }
    return html + "</tbody></table></div>\n";
}

}  // namespace

std::vector<std::string> options_that_differ(std::span<const RunFolder> runs) {
    std::vector<std::string> differing;
    for (const std::string& name : names_of(runs)) {
        const auto first = value_of(runs.front(), name);
        if (std::any_of(runs.begin(), runs.end(),
                        [&](const RunFolder& run) { return value_of(run, name) != first; }))
            differing.push_back(name);
    }
    return differing;
}

std::string differing_options(std::span<const RunFolder> runs) {
    if (runs.size() < 2) return {};
    const std::vector<std::string> names = options_that_differ(runs);
    if (names.empty()) return "<p class=\"same\">The runs were given the same options.</p>\n";
    return table(runs, names, "What differs");
}

std::string options_table(std::span<const RunFolder> runs) { return table(runs, names_of(runs), "Options"); }

}  // namespace ridgeline::app::report
