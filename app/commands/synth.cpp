// ridgeline synth: made-up mountains as a GeoTIFF.
#include <cstdio>
#include <memory>
#include <string>

#include "ridgeline/app/command.h"
#include "ridgeline/app/options.h"
#include "ridgeline/app/progress.h"
#include "ridgeline/app/stop_signal.h"
#include "ridgeline/jobs/job_system.h"
#include "ridgeline/synth/synth.h"

namespace ridgeline::app {
namespace {

constexpr std::int64_t kMostSamples = 1 << 20;  // a side; a TiB of heights

Result<std::uint64_t> parse_seed(const std::string& text) {
    const auto seed = parse_integer(text, {0, INT64_MAX});
    if (!seed) return seed.error();
    return static_cast<std::uint64_t>(*seed);
}

Result<int> parse_ratio(const std::string& text) {
    const auto ratio = parse_integer(text, {1, 16});
    if (!ratio) return ratio.error();
    return static_cast<int>(*ratio);
}

void add_synth_options(Syntax syntax, synth::SynthOptions& options) {
    add_text(syntax, "OUT.tif", options.path, "", "The GeoTIFF to write").required();
    add_value(syntax, "--size", options.size, "N", "Samples along either side", [](const std::string& text) {
        return parse_integer(text, {2, kMostSamples});
    }).shown_default(std::to_string(options.size));
    add_value(syntax, "--spacing", options.spacing_m, "M", "Metres between samples",
              [](const std::string& text) {
                  return parse_number(text, {0.001, 10000.0});
              })
        .shown_default("10");
    add_value(syntax, "--seed", options.seed, "N", "Another seed, other mountains", parse_seed)
        .shown_default("1");
    const auto force = [&options] { options.replace = synth::Replace::existing; };
    syntax.flag("--force", force, "Replace the file that stands there");
    add_text(syntax, "--imagery", options.imagery_path, "OUT_RGB.tif",
             "A GeoTIFF of what the ground looks like, beside it");
    const Syntax of_imagery = syntax.group(
        "Of --imagery", [&options] { return !options.imagery_path.empty(); },
        "is of --imagery, which is not given");
    add_value(of_imagery, "--imagery-ratio", options.imagery_ratio, "N", "Texels of it a sample: 1 to 16",
              parse_ratio)
        .shown_default("3");
}

Result<void> synthesise(synth::SynthOptions options, const RunContext& context) {
    options.stop = &watch_stop_signals();
    jobs::JobSystem jobs;
    {
        Progress progress("making " + options.path, "rows", Progress::style(context.quiet));
        RIDGELINE_TRY(synth::synth(
            options, jobs, [&](std::int64_t done, std::int64_t rows) { progress.report(done, rows); }));
    }
    if (!context.quiet)
        std::printf("%s: %lld x %lld samples, %g m apart\n", options.path.c_str(),
                    static_cast<long long>(options.size), static_cast<long long>(options.size),
                    options.spacing_m);
    if (context.quiet || options.imagery_path.empty()) return {};
    const std::int64_t texels = (options.size - 1) * options.imagery_ratio + 1;
    std::printf("%s: %lld x %lld texels, %g m apart\n", options.imagery_path.c_str(),
                static_cast<long long>(texels), static_cast<long long>(texels),
                options.spacing_m / options.imagery_ratio);
    return {};
}

}  // namespace

void add_synth(Program& program) {
    auto options = std::make_shared<synth::SynthOptions>();
    const Syntax syntax = program.add("synth", "Make up mountains as a GeoTIFF",
                                      "ridgeline synth alps.tif --size 4097 --seed 7 --imagery alps_rgb.tif");
    add_synth_options(syntax, *options);
    program.runs("synth", [options](const RunContext& context) { return synthesise(*options, context); });
}

}  // namespace ridgeline::app
