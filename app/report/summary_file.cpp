#include "ridgeline/app/report/summary_file.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "ridgeline/base/json_text.h"
#include "ridgeline/base/whole_file.h"

namespace ridgeline::app::report {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kLargestFile_bytes = std::size_t{1} << 24;
constexpr const char* kFormat = "ridgeline-telemetry-1";
// Figures lie one object deep; a file that nests without end is not followed.
constexpr int kDeepest = 3;

std::string text_of(const Json& value) {
    return value.is_string() ? value.get<std::string>() : json_text(value);
}

std::string text_at(const Json& json, const char* key) {
    const auto found = json.find(key);
    return found != json.end() && found->is_string() ? found->get<std::string>() : std::string();
}

void collect_figures(const Json& json, const std::string& prefix, int depth, SummaryFile& summary) {
    for (const auto& [key, value] : json.items()) {
        if (value.is_object() && depth < kDeepest && prefix + key != "options")
            collect_figures(value, prefix + key + '.', depth + 1, summary);
        if (value.is_number() && std::isfinite(value.get<double>()))
            summary.figures.emplace(prefix + key, value.get<double>());
    }
}

}  // namespace

const double* SummaryFile::find(std::string_view figure) const {
    const auto found = figures.find(figure);
    return found != figures.end() ? &found->second : nullptr;
}

const std::string* SummaryFile::find_option(std::string_view option) const {
    for (const auto& [name, value] : options)
        if (name == option) return &value;
    return nullptr;
}

Result<SummaryFile> parse_summary(std::string_view text, const std::string& name) {
    const Json json = parse_json(text);
    if (!json.is_object()) return Error{name + ": is not JSON as a walk writes it; was it cut short?"};
    if (text_at(json, "format") != kFormat)
        return Error{name + ": is not of the format " + kFormat + ", which this release reads"};
    SummaryFile summary;
    summary.dataset = text_at(json, "dataset");
    summary.gl_renderer = text_at(json, "gl_renderer");
    if (const auto options = json.find("options"); options != json.end() && options->is_object())
        for (const auto& [option, value] : options->items())
            summary.options.emplace_back(option, text_of(value));
    collect_figures(json, "", 0, summary);
    return summary;
}

Result<SummaryFile> read_summary(const std::filesystem::path& file) {
    const auto text = read_text_file(file, kLargestFile_bytes);
    if (!text) return text.error();
    return parse_summary(*text, file.string());
}

}  // namespace ridgeline::app::report
