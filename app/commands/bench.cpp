// ridgeline bench: runs variants of one thing side by side and writes what each did.
#include <cstdio>
#include <map>
#include <memory>
#include <system_error>

#include "ridgeline/app/bench/horizon_suite.h"
#include "ridgeline/app/bench/metric_suite.h"
#include "ridgeline/app/command.h"
#include "ridgeline/app/progress.h"
#include "ridgeline/base/log.h"
#include "ridgeline/base/thread_role.h"
#include "ridgeline/base/whole_file.h"
#include "ridgeline/gl/capabilities.h"
#include "ridgeline/platform/context.h"

namespace ridgeline::app {
namespace {

struct BenchOptions {
    std::filesystem::path directory;
    std::string suite;
    std::filesystem::path out;
    std::vector<std::string> sources;
    HorizonSuiteOptions horizon;
};

struct SuiteReport {
    Figures figures;
    std::string table;
    // What the figures say of the program: an error where they show a fault.
    Result<void> verdict;
};

// A context that GL's functions are loaded for, current on this thread, which is the render thread from now on.
Result<std::unique_ptr<platform::Context>> open_gl(const glm::ivec2& size_px) {
    set_thread_role(ThreadRole::render, "render");
    auto headless = platform::open_headless({.size_px = size_px});
    if (!headless) return headless.error();
    RIDGELINE_TRY(gl::load((*headless)->gl_loader()));
    return headless;
}

Result<SuiteReport> run_metric(const BenchOptions& options, const RunContext& context) {
    const MetricPictureOptions pictures{.folder = options.out};
    const auto headless = open_gl(pictures.lens.size_px);
    if (!headless) log_line(LogLevel::warn, "pictures are left out: " + headless.error().message);
    Progress progress("comparing metrics", "surfaces", Progress::style(context.quiet));
    MetricSuiteOptions suite;
    if (headless) suite.pictures = pictures;
    suite.progress = [&](std::int64_t done, std::int64_t total) { progress.report(done, total); };
    auto figures = run_metric_suite({options.directory, options.sources}, suite);
    if (!figures) return figures.error();
    std::string table = figures->to_table();
    return SuiteReport{std::move(*figures), std::move(table), {}};
}

Result<SuiteReport> run_horizon(const BenchOptions& options, const RunContext& context) {
    const auto store = io::Store::open(options.directory);
    if (!store) return store.error();
    const auto headless = open_gl(options.horizon.size_px);
    if (!headless) return headless.error();
    Progress progress("walking and looking", "frames", Progress::style(context.quiet));
    HorizonSuiteOptions suite = options.horizon;
    suite.progress = [&](std::int64_t done, std::int64_t total) { progress.report(done, total); };
    auto figures = run_horizon_suite(*store, suite);
    if (!figures) return figures.error();
    SuiteReport report{std::move(*figures), {}, {}};
    report.table = horizon_tables(report.figures);
    if (const std::int64_t wrong = wrongly_culled(report.figures); wrong > 0)
        report.verdict = Error{options.directory.string() + ": " + std::to_string(wrong) +
                               " nodes were left out that the oracle sees"};
    return report;
}

using Suite = Result<SuiteReport> (*)(const BenchOptions& options, const RunContext& context);
const std::map<std::string, Suite> kSuites = {{"metric", run_metric}, {"horizon", run_horizon}};

Result<void> bench(const BenchOptions& options, const RunContext& context) {
    std::error_code failed;
    std::filesystem::create_directories(options.out, failed);
    if (failed) return Error{options.out.string() + ": cannot make the folder: " + failed.message()};
    const auto report = kSuites.at(options.suite)(options, context);
    if (!report) return report.error();
    if (!context.quiet) std::fputs(report->table.c_str(), stdout);
    RIDGELINE_TRY(write_whole_file(options.out / (options.suite + ".json"), report->figures.to_json()));
    return report->verdict;
}

void add_metric_options(Syntax syntax, BenchOptions& options) {
    add_texts(syntax, "--source", options.sources, "RASTER",
              "Rasters to build from instead of the store's heights");
}

void add_horizon_options(Syntax syntax, HorizonSuiteOptions& options) {
    add_value(syntax, "--path", options.path, "ground|orbit|FILE", "The path to walk", parse_path_choice);
    add_value(syntax, "--size", options.size_px, "WIDTHxHEIGHT", "Of the picture", parse_size);
    add_value(syntax, "--pixel-error", options.pixel_error_px, "PIXELS", "As in a walk", parse_positive);
    add_value(syntax, "--frames", options.frames, "N", "Of each walk, spread over the path",
              [](const std::string& text) {
                  return parse_integer(text, {1, 1'000'000});
              })
        .shown_default(std::to_string(options.frames));
    add_value(syntax, "--views", options.views, "N", "Random ones at each height",
              [](const std::string& text) {
                  return parse_integer(text, {1, 100'000});
              })
        .shown_default(std::to_string(options.views));
    add_caches(syntax, options.caches);
}

// The options of one suite, which are wrong usage with any other.
Syntax add_suite_group(Syntax syntax, const std::string& suite, const BenchOptions& options) {
    return syntax.group(
        "Options of --suite " + suite, [suite, &options] { return options.suite == suite; },
        "is of --suite " + suite + " alone");
}

}  // namespace

void add_bench(Program& program) {
    auto options = std::make_shared<BenchOptions>();
    const Syntax syntax = program.add("bench", "Compare variants of one thing on a store",
                                      "ridgeline bench alps.terrain --suite metric --out figures");
    add_store(syntax, options->directory);
    Choice suites;
    for (const auto& [name, run] : kSuites) suites.offered.push_back(name);
    add_choice(syntax, "--suite", options->suite, suites, "What to compare").required();
    add_path(syntax, "--out", options->out, "DIR", "The folder for SUITE.json, and for pictures").required();
    add_metric_options(add_suite_group(syntax, "metric", *options), *options);
    add_horizon_options(add_suite_group(syntax, "horizon", *options), options->horizon);
    program.runs("bench", [options](const RunContext& context) { return bench(*options, context); });
}

}  // namespace ridgeline::app
