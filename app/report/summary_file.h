// summary.json as a walk wrote it: what was run, and its figures by the names that INTERFACE gives them.
//
// Figures that are missing are just not there; what is no summary at all is refused. Any thread.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ridgeline/base/result.h"

namespace ridgeline::app::report {

struct SummaryFile {
    std::string dataset;
    std::string gl_renderer;
    // As text, by name.
    std::vector<std::pair<std::string, std::string>> options;
    // Keys joined by dots: "frame_ms.p99".
    std::map<std::string, double, std::less<>> figures;

    // Null where it is missing.
    const double* find(std::string_view figure) const;
    const std::string* find_option(std::string_view option) const;
};

Result<SummaryFile> parse_summary(std::string_view text, const std::string& name);
Result<SummaryFile> read_summary(const std::filesystem::path& file);

}  // namespace ridgeline::app::report
