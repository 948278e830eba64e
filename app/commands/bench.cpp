// ridgeline bench: runs variants of one thing side by side and writes what each did.
#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <system_error>
#include <thread>

#include "ridgeline/app/bench/horizon_suite.h"
#include "ridgeline/app/bench/imagery_suite.h"
#include "ridgeline/app/bench/metric_suite.h"
#include "ridgeline/app/bench/quadtree_suite.h"
#include "ridgeline/app/bench/scheduling_suite.h"
#include "ridgeline/app/bench/stress_suite.h"
#include "ridgeline/app/bench/stress_variants.h"
#include "ridgeline/app/bench/synthesis_suite.h"
#include "ridgeline/app/command.h"
#include "ridgeline/app/progress.h"
#include "ridgeline/base/log.h"
#include "ridgeline/base/thread_role.h"
#include "ridgeline/base/whole_file.h"
#include "ridgeline/gl/capabilities.h"
#include "ridgeline/gpu_encoder/gpu_encoder.h"
#include "ridgeline/platform/context.h"

namespace ridgeline::app {
namespace {

// Of the suites that walk.
struct WalkedOptions {
    std::optional<PathChoice> path;  // none: the suite's own
    std::int64_t frames = 300;
    glm::ivec2 size_px{1024, 768};
    double pixel_error_px = 1.0;
    CacheSizes caches;
};

struct BenchOptions {
    std::filesystem::path directory;
    std::string suite;
    std::filesystem::path out;
    std::vector<std::string> sources;
    WalkedOptions walked;
    int views = HorizonSuiteOptions{}.views;
    std::vector<std::string> variants;  // none: all
    std::filesystem::path beside;       // empty: none
};

struct SuiteReport {
    Figures figures;
    std::string table;
    // What the figures say of the program: an error where they show a fault.
    Result<void> verdict;
    std::string csv = {};  // curves over the walk, where the suite has any
};

// A context that GL's functions are loaded for, current on this thread, which is the render thread from now
// on.
Result<std::unique_ptr<platform::Context>> open_gl(const glm::ivec2& size_px) {
    set_thread_role(ThreadRole::render, "render");
    auto headless = platform::open_headless({.size_px = size_px});
    if (!headless) return headless.error();
    RIDGELINE_TRY(gl::load((*headless)->gl_loader()));
    return headless;
}

// What the suites that walk need.
struct WalkedGround {
    io::Store store;
    std::unique_ptr<platform::Context> context;
};

Result<WalkedGround> open_walked(const BenchOptions& options) {
    auto store = io::Store::open(options.directory);
    if (!store) return store.error();
    auto headless = open_gl(options.walked.size_px);
    if (!headless) return headless.error();
    return WalkedGround{std::move(*store), std::move(*headless)};
}

template <class Suite>
void walk_as_asked(const WalkedOptions& options, Suite& suite) {
    suite.frames = options.frames;
    suite.size_px = options.size_px;
    suite.pixel_error_px = options.pixel_error_px;
    suite.caches = options.caches;
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
    const auto ground = open_walked(options);
    if (!ground) return ground.error();
    Progress progress("walking and looking", "frames", Progress::style(context.quiet));
    HorizonSuiteOptions suite;
    if (options.walked.path) suite.path = *options.walked.path;
    walk_as_asked(options.walked, suite);
    suite.views = options.views;
    suite.progress = [&](std::int64_t done, std::int64_t total) { progress.report(done, total); };
    auto figures = run_horizon_suite(ground->store, suite);
    if (!figures) return figures.error();
    SuiteReport report{std::move(*figures), {}, {}};
    report.table = horizon_tables(report.figures);
    if (const std::int64_t wrong = wrongly_culled(report.figures); wrong > 0)
        report.verdict = Error{options.directory.string() + ": " + std::to_string(wrong) +
                               " nodes were left out that the oracle sees"};
    return report;
}

Result<SuiteReport> run_scheduling(const BenchOptions& options, const RunContext& context) {
    const auto ground = open_walked(options);
    if (!ground) return ground.error();
    Progress progress("walking", "frames", Progress::style(context.quiet));
    SchedulingSuiteOptions suite;
    if (options.walked.path) suite.paths = {*options.walked.path};
    walk_as_asked(options.walked, suite);
    suite.progress = [&](std::int64_t done, std::int64_t total) { progress.report(done, total); };
    auto report = run_scheduling_suite(ground->store, suite);
    if (!report) return report.error();
    std::string table = scheduling_table(report->figures);
    return SuiteReport{std::move(report->figures), std::move(table), {}, std::move(report->csv)};
}

Result<SuiteReport> run_quadtree(const BenchOptions& options, const RunContext& context) {
    const auto ground = open_walked(options);
    if (!ground) return ground.error();
    Progress progress("walking", "frames", Progress::style(context.quiet));
    QuadtreeSuiteOptions suite;
    if (options.walked.path) suite.path = *options.walked.path;
    walk_as_asked(options.walked, suite);
    suite.progress = [&](std::int64_t done, std::int64_t total) { progress.report(done, total); };
    auto figures = run_quadtree_suite(ground->store, suite);
    if (!figures) return figures.error();
    std::string table = quadtree_tables(*figures);
    return SuiteReport{std::move(*figures), std::move(table), {}};
}

Result<SuiteReport> run_synthesis(const BenchOptions& options, const RunContext& context) {
    const auto ground = open_walked(options);
    if (!ground) return ground.error();
    Progress progress("descending", "frames", Progress::style(context.quiet));
    SynthesisSuiteOptions suite;
    if (options.walked.path) suite.path = *options.walked.path;
    walk_as_asked(options.walked, suite);
    suite.pictures.folder = options.out;
    suite.progress = [&](std::int64_t done, std::int64_t total) { progress.report(done, total); };
    auto report = run_synthesis_suite(ground->store, suite);
    if (!report) return report.error();
    std::string table = synthesis_tables(report->figures);
    return SuiteReport{std::move(report->figures), std::move(table), {}, std::move(report->csv)};
}

Result<SuiteReport> run_stress(const BenchOptions& options, const RunContext& context) {
    const auto ground = open_walked(options);
    if (!ground) return ground.error();
    std::optional<io::Store> beside;
    if (!options.beside.empty()) {
        auto opened = io::Store::open(options.beside);
        if (!opened) return opened.error();
        beside.emplace(std::move(*opened));
    }
    Progress progress("walking", "frames", Progress::style(context.quiet));
    StressSuiteOptions suite;
    suite.path = options.walked.path;
    suite.variants = options.variants;
    walk_as_asked(options.walked, suite);
    if (beside) suite.beside = &*beside;
    suite.progress = [&](std::int64_t done, std::int64_t total) { progress.report(done, total); };
    auto figures = run_stress_suite(ground->store, suite);
    if (!figures) return figures.error();
    std::string table = stress_tables(*figures);
    Result<void> verdict = stress_verdict(*figures);
    if (!verdict) verdict = Error{options.directory.string() + ": " + verdict.error().message};
    return SuiteReport{std::move(*figures), std::move(table), std::move(verdict)};
}

Result<SuiteReport> run_imagery(const BenchOptions& options, const RunContext& context) {
    const auto on_cpu = build::make_cpu_encoder();
    const auto on_gpu = build::GpuEncoder::create();
    std::vector<NamedEncoder> encoders = {{"cpu", on_cpu.get()}};
    if (on_gpu)
        encoders.push_back({"gpu", on_gpu->get()});
    else
        log_line(LogLevel::warn, "the GPU's encoder is left out: " + on_gpu.error().message);
    Progress progress("encoding", "steps", Progress::style(context.quiet));
    ImagerySuiteOptions suite;
    suite.scratch = options.out;
    suite.threads = static_cast<int>(std::thread::hardware_concurrency());
    suite.progress = [&](std::int64_t done, std::int64_t total) { progress.report(done, total); };
    auto figures = run_imagery_suite({options.directory, options.sources}, encoders, suite);
    if (!figures) return figures.error();
    std::string table = figures->to_table();
    return SuiteReport{std::move(*figures), std::move(table), {}};
}

using Suite = Result<SuiteReport> (*)(const BenchOptions& options, const RunContext& context);
const std::map<std::string, Suite> kSuites = {{"metric", run_metric},         {"horizon", run_horizon},
                                              {"imagery", run_imagery},       {"quadtree", run_quadtree},
                                              {"scheduling", run_scheduling}, {"stress", run_stress},
                                              {"synthesis", run_synthesis}};

Result<void> bench(const BenchOptions& options, const RunContext& context) {
    std::error_code failed;
    std::filesystem::create_directories(options.out, failed);
    if (failed) return Error{options.out.string() + ": cannot make the folder: " + failed.message()};
    const auto report = kSuites.at(options.suite)(options, context);
    if (!report) return report.error();
    if (!context.quiet) std::fputs(report->table.c_str(), stdout);
    if (!report->csv.empty())
        RIDGELINE_TRY(write_whole_file(options.out / (options.suite + ".csv"), report->csv));
    RIDGELINE_TRY(write_whole_file(options.out / (options.suite + ".json"), report->figures.to_json()));
    return report->verdict;
}

void add_source_options(Syntax syntax, BenchOptions& options) {
    add_texts(syntax, "--source", options.sources, "RASTER",
              "Rasters to build from instead of the store's heights, or of its imagery's own");
}

Option add_count(Syntax syntax, const std::string& name, auto& target, const std::string& help,
                 std::int64_t most) {
    return add_value(syntax, name, target, "N", help,
                     [most](const std::string& text) {
                         return parse_integer(text, {1, most});
                     })
        .shown_default(std::to_string(target));
}

void add_walked_options(Syntax syntax, WalkedOptions& options) {
    add_value(syntax, "--path", options.path, "ground|orbit|FILE", "The path to walk", parse_path_choice);
    add_value(syntax, "--size", options.size_px, "WIDTHxHEIGHT", "Of the picture", parse_size);
    add_value(syntax, "--pixel-error", options.pixel_error_px, "PIXELS", "As in a walk", parse_positive);
    add_count(syntax, "--frames", options.frames, "Of each walk, spread over the path", 1'000'000);
    add_caches(syntax, options.caches);
}

// Options of some suites, which are wrong usage with any other.
Syntax add_suite_group(Syntax syntax, const std::vector<std::string>& suites, const BenchOptions& options) {
    std::string names = suites.front();
    for (std::size_t i = 1; i < suites.size(); ++i)
        names += (i + 1 < suites.size() ? ", " : " and ") + suites[i];
    return syntax.group(
        "Options of --suite " + names,
        [suites, &options] { return std::ranges::find(suites, options.suite) != suites.end(); },
        "is of --suite " + names + " alone");
}

Result<std::string> parse_variant(const std::string& text) {
    const std::vector<std::string> names = stress_variant_names();
    if (std::ranges::find(names, text) != names.end()) return text;
    std::string known;
    for (const std::string& name : names) known += (known.empty() ? "" : ", ") + name;
    return Error{"'" + text + "' is not known: use " + known};
}

void add_stress_options(Syntax syntax, BenchOptions& options) {
    add_values(syntax, "--variant", options.variants, "NAME",
               "Caches and disk of this name alone; may be repeated", parse_variant)
        .one_value_each();
    add_path(syntax, "--beside", options.beside, "DIR",
             "Another store that holds the same ground: its frames beside this one's");
}

}  // namespace

void add_bench(Program& program) {
    auto options = std::make_shared<BenchOptions>();
    const Syntax syntax = program.add("bench", "Compare variants of one thing on a store",
                                      "ridgeline bench alps.terrain --suite metric --out figures");
    add_store(syntax, options->directory);
    std::vector<std::string> suites;
    for (const auto& [name, run] : kSuites) suites.push_back(name);
    add_choice(syntax, "--suite", options->suite, suites, "What to compare").required();
    add_path(syntax, "--out", options->out, "DIR", "The folder for SUITE.json, curves and pictures")
        .required();
    add_source_options(add_suite_group(syntax, {"metric", "imagery"}, *options), *options);
    add_walked_options(
        add_suite_group(syntax, {"horizon", "scheduling", "quadtree", "stress", "synthesis"}, *options),
        options->walked);
    add_count(add_suite_group(syntax, {"horizon"}, *options), "--views", options->views,
              "Random ones at each height", 100'000);
    add_stress_options(add_suite_group(syntax, {"stress"}, *options), *options);
    program.runs("bench", [options](const RunContext& context) { return bench(*options, context); });
}

}  // namespace ridgeline::app
