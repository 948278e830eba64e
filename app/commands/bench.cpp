// ridgeline bench: runs variants of one thing side by side and writes what each did.
#include <cstdio>
#include <map>
#include <memory>
#include <system_error>

#include "ridgeline/app/bench/metric_suite.h"
#include "ridgeline/app/command.h"
#include "ridgeline/app/progress.h"
#include "ridgeline/base/whole_file.h"

namespace ridgeline::app {
namespace {

struct BenchOptions {
    std::filesystem::path directory;
    std::string suite;
    std::filesystem::path out;
    std::vector<std::string> sources;
};

Result<Figures> run_metric(const BenchOptions& options, const RunContext& context) {
    Progress progress("comparing metrics", "surfaces", Progress::style(context.quiet));
    MetricSuiteOptions suite;
    suite.progress = [&](std::int64_t done, std::int64_t total) { progress.report(done, total); };
    return run_metric_suite({options.directory, options.sources}, suite);
}

using Suite = Result<Figures> (*)(const BenchOptions& options, const RunContext& context);
const std::map<std::string, Suite> kSuites = {{"metric", run_metric}};

Result<void> bench(const BenchOptions& options, const RunContext& context) {
    std::error_code failed;
    std::filesystem::create_directories(options.out, failed);
    if (failed) return Error{options.out.string() + ": cannot make the folder: " + failed.message()};
    const auto figures = kSuites.at(options.suite)(options, context);
    if (!figures) return figures.error();
    if (!context.quiet) std::fputs(figures->to_table().c_str(), stdout);
    return write_whole_file(options.out / (options.suite + ".json"), figures->to_json());
}

}  // namespace

void add_bench(Program& program) {
    auto options = std::make_shared<BenchOptions>();
    CLI::App& syntax = program.add("bench", "Compare variants of one thing on a store",
                                   "ridgeline bench alps.terrain --suite metric --out figures");
    add_store(syntax, options->directory);
    Choice suites;
    for (const auto& [name, run] : kSuites) suites.offered.push_back(name);
    add_choice(syntax, "--suite", options->suite, suites, "What to compare")->required();
    syntax.add_option("--out", options->out, "The folder for SUITE.json")->required()->type_name("DIR");
    syntax.add_option("--source", options->sources, "Rasters to build from instead of the store's heights")
        ->type_name("RASTER");
    program.runs(syntax, [options](const RunContext& context) { return bench(*options, context); });
}

}  // namespace ridgeline::app
