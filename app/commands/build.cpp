// ridgeline build: turns rasters into a terrain store, or gives one that stands its imagery.
#include <cstdio>
#include <limits>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "ridgeline/app/command.h"
#include "ridgeline/app/options.h"
#include "ridgeline/app/progress.h"
#include "ridgeline/app/stop_signal.h"
#include "ridgeline/base/units.h"
#include "ridgeline/build/builder.h"
#include "ridgeline/build/imagery/imagery_layer.h"
#include "ridgeline/gpu_encoder/gpu_encoder.h"

namespace ridgeline::app {
namespace {

constexpr std::int64_t kMostJobs = 1024;

Result<int> parse_tile(const std::string& text) {
    for (const int tile : {33, 65, 129})
        if (text == std::to_string(tile)) return tile;
    return Error{"'" + text + "' is no tile size: use 33, 65 or 129"};
}

// What fits that many bytes a node. Longer steps would save more, but cut off the ridges between.
Result<io::ReliefShape> parse_relief(const std::string& text) {
    if (text == "2048") return io::ReliefShape{};
    if (text == "1024") return io::ReliefShape{.bands = 6, .steps = 16, .cells = 16};
    if (text == "512") return io::ReliefShape{.bands = 2, .steps = 16, .cells = 16};
    return Error{"'" + text + "' is no size of a relief: use 512, 1024 or 2048"};
}

Result<double> parse_nodata(const std::string& text) {
    if (text == "nan" || text == "NaN") return std::numeric_limits<double>::quiet_NaN();
    constexpr double kMost = std::numeric_limits<double>::max();
    return parse_number(text, {-kMost, kMost});
}

Result<std::string> parse_raster(const std::string& text) {
    if (text.empty()) return Error{"'' names no raster"};
    return text;
}

Result<int> parse_jobs(const std::string& text) {
    const auto jobs = parse_integer(text, {1, kMostJobs});
    if (!jobs) return jobs.error();
    return static_cast<int>(*jobs);
}

// What means nothing without heights to build.
void add_height_options(Syntax syntax, build::BuildOptions& options, std::string& metric) {
    add_value(syntax, "--crs", options.crs, "EPSG:n",
              "A metric system to build in; none: the rasters' own, or UTM", parse_crs);
    add_value(syntax, "--nodata", options.nodata, "V",
              "The value that means no height; none: as the rasters say", parse_nodata);
    add_value(syntax, "--tile", options.tile, "N", "Samples a tile's side: 33, 65 or 129", parse_tile)
        .shown_default("65");
    add_value(syntax, "--relief", options.relief, "BYTES",
              "What a node may take to say what it hides: 512, 1024 or 2048", parse_relief)
        .shown_default("2048");
    add_choice(syntax, "--metric", metric, {"cone", "geometric"},
               "What decides which vertices a level keeps");
}

struct BuildCommand {
    build::BuildOptions options;
    std::string metric;
    bool on_gpu = false;
};

// What means nothing without pictures.
void add_imagery_options(Syntax syntax, BuildCommand& given) {
    const Syntax pictures = syntax.group(
        "Of imagery", [&given] { return !given.options.imagery.empty(); },
        "is of imagery, and no --imagery is given");
    pictures.flag(
        "--gpu", [&given] { given.on_gpu = true; }, "Compress on the GPU, not on the CPU");
}

void add_build_options(Syntax syntax, BuildCommand& given) {
    build::BuildOptions& options = given.options;
    add_values(syntax, "DEM", options.sources, "", "Rasters of heights; later ones cover earlier ones",
               parse_raster);
    add_path(syntax, "--out", options.out, "DIR.terrain", "The store to make; without DEM, one that stands")
        .required();
    add_values(syntax, "--imagery", options.imagery, "RASTER",
               "Pictures of the ground; later ones cover earlier ones", parse_raster);
    syntax.require(
        "DEM", [&options] { return !options.sources.empty() || !options.imagery.empty(); }, "is required");
    const Syntax heights = syntax.group(
        "Of heights", [&options] { return !options.sources.empty(); }, "is of heights, and no DEM is given");
    add_height_options(heights, options, given.metric);
    add_imagery_options(syntax, given);
    add_value(syntax, "--jobs", options.jobs, "N", "Threads that compute; none: one a core", parse_jobs);
    add_value(syntax, "--memory", options.memory_bytes, "SIZE", "Memory to work in", parse_capacity)
        .shown_default("1GiB");
    const auto force = [&options] { options.replace = io::Replace::existing; };
    syntax.flag("--force", force, "Replace the store that stands there, or its imagery");
}

// What the builder counts in each stage.
const char* unit_of(build::Stage stage) {
    if (stage == build::Stage::read || stage == build::Stage::imagery) return "rows";
    return stage == build::Stage::write ? "tiles" : "blocks";
}

void print_notes(const std::vector<std::string>& notes) {
    for (const std::string& note : notes) std::printf("note: %s\n", note.c_str());
}

void print_imagery(const std::string& name, const io::ImageryInfo& imagery) {
    std::printf("%s: imagery of %lld x %lld texels, %s, %s, %s\n", name.c_str(),
                static_cast<long long>(imagery.width), static_cast<long long>(imagery.height),
                counted(imagery.grid().levels(), "level").c_str(), counted(imagery.tiles, "tile").c_str(),
                format_bytes(static_cast<std::uint64_t>(imagery.bytes)).c_str());
    print_notes(imagery.notes);
}

void print_report(const std::string& name, const build::BuildReport& report) {
    const io::TerrainInfo& info = report.info;
    const double samples = static_cast<double>(info.width) * static_cast<double>(info.height);
    std::printf("%s: %lld x %lld samples, %s, %s, %s in %.1f s (%.1f M samples/s)\n", name.c_str(),
                static_cast<long long>(info.width), static_cast<long long>(info.height),
                counted(info.grid().levels(), "level").c_str(), counted(info.triangles, "triangle").c_str(),
                format_bytes(static_cast<std::uint64_t>(info.heights_bytes + info.mesh_bytes)).c_str(),
                report.seconds, samples / report.seconds / 1e6);
    print_notes(info.notes);
    if (info.imagery) print_imagery(name, *info.imagery);
}

// A DEM that was written after --imagery was taken for a picture of a store that is yet to be built.
Result<void> check_stands(const std::filesystem::path& store) {
    std::error_code failed;
    if (std::filesystem::exists(store / io::kInfoFile, failed) || failed) return {};
    return Error{store.string() +
                 ": no store stands there; rasters after --imagery are pictures; name the DEM first"};
}

// To a store that stands.
Result<void> build_imagery(const build::BuildOptions& options, const RunContext& context) {
    RIDGELINE_TRY(check_stands(options.out));
    build::AddImageryOptions adding;
    adding.sources = options.imagery;
    adding.store = options.out;
    adding.replace = options.replace;
    adding.jobs = options.jobs;
    adding.memory_bytes = options.memory_bytes;
    adding.encoder = options.encoder;
    adding.stop = &watch_stop_signals();
    auto added = [&] {
        Progress progress("adding imagery to " + options.out.string(), "rows",
                          Progress::style(context.quiet));
        adding.progress = [&progress](build::ImageryStage stage, std::int64_t done, std::int64_t total) {
            const bool tiles = stage == build::ImageryStage::tiles;
            progress.report(tiles ? Progress::Phase{"imagery", "rows"} : Progress::Phase{"write", "tiles"},
                            done, total);
        };
        return build::add_imagery(adding);
    }();
    if (!added) return added.error();
    if (context.quiet) return {};
    print_imagery(options.out.string(), *added->info.imagery);
    const io::ImageryInfo& imagery = *added->info.imagery;
    const double texels = static_cast<double>(imagery.width) * static_cast<double>(imagery.height);
    std::printf("%s: in %.1f s (%.1f M texels/s)\n", options.out.c_str(), added->seconds,
                texels / added->seconds / 1e6);
    return {};
}

Result<void> build_store(build::BuildOptions options, const RunContext& context) {
    options.stop = &watch_stop_signals();
    auto built = [&] {
        Progress progress("building " + options.out.string(), "blocks", Progress::style(context.quiet));
        options.progress = [&progress](build::Stage stage, std::int64_t done, std::int64_t total) {
            progress.report({build::stage_name(stage), unit_of(stage)}, done, total);
        };
        return build::build_terrain(options);
    }();
    if (!built) return built.error();
    if (!context.quiet) print_report(options.out.string(), *built);
    return {};
}

Result<void> run_build(build::BuildOptions options, const BuildCommand& given, const RunContext& context) {
    std::unique_ptr<build::GpuEncoder> encoder;
    if (given.on_gpu) {
        auto opened = build::GpuEncoder::create();
        if (!opened) return Error{"--gpu: " + opened.error().message};
        encoder = std::move(opened).value();
        options.encoder = encoder.get();
    }
    if (options.sources.empty()) return build_imagery(options, context);
    options.metric = given.metric == "cone" ? build::Metric::cone : build::Metric::geometric;
    return build_store(options, context);
}

}  // namespace

void add_build(Program& program) {
    auto given = std::make_shared<BuildCommand>();
    const Syntax syntax =
        program.add("build", "Turn rasters of heights, and pictures of the ground, into a store",
                    "ridgeline build alps.tif --out alps.terrain --imagery ortho.tif\n"
                    "  ridgeline build --out alps.terrain --imagery ortho.tif");
    add_build_options(syntax, *given);
    program.runs("build",
                 [given](const RunContext& context) { return run_build(given->options, *given, context); });
}

}  // namespace ridgeline::app
