// ridgeline report: one HTML page about one walk, or several side by side.
#include <cstdio>
#include <memory>
#include <vector>

#include "ridgeline/app/command.h"
#include "ridgeline/app/report/page.h"
#include "ridgeline/app/report/report_file.h"
#include "ridgeline/app/report/run_folder.h"

namespace ridgeline::app {
namespace {

struct ReportOptions {
    std::vector<std::filesystem::path> folders;
    std::filesystem::path out;
};

Result<void> report_runs(const ReportOptions& options, const RunContext& context) {
    const auto runs = report::read_runs(options.folders, report::kMostPictures);
    if (!runs) return runs.error();
    RIDGELINE_TRY(report::write_report(options.out, report::page_of(*runs), options.folders));
    if (!context.quiet) std::printf("%s\n", options.out.c_str());
    return {};
}

}  // namespace

void add_report(Program& program) {
    auto options = std::make_shared<ReportOptions>();
    const Syntax syntax = program.add("report", "Make one page of the telemetry of walks, side by side",
                                      "ridgeline report telemetry/ridges telemetry/off --out report.html");
    const auto take_folder = [options](const std::string& text) -> Result<std::filesystem::path> {
        if (options->folders.size() == report::kMostRuns)
            return Error{"more than " + std::to_string(report::kMostRuns) +
                         " runs cannot be told apart on a page"};
        return std::filesystem::path(text);
    };
    add_values(syntax, "TELEMETRY_DIR", options->folders, "",
               "What walk --telemetry wrote; the first is compared with", take_folder)
        .required();
    add_path(syntax, "--out", options->out, "FILE.html", "The page, whole in one file").required();
    program.runs("report", [options](const RunContext& context) { return report_runs(*options, context); });
}

}  // namespace ridgeline::app
