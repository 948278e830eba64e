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
    refuse_option(syntax, "--imagery");
    refuse_option(syntax, "--imagery-ratio");
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
    return {};
}

}  // namespace

void add_synth(Program& program) {
    auto options = std::make_shared<synth::SynthOptions>();
    const Syntax syntax = program.add("synth", "Make up mountains as a GeoTIFF",
                                      "ridgeline synth alps.tif --size 4097 --seed 7");
    add_synth_options(syntax, *options);
    program.runs("synth", [options](const RunContext& context) { return synthesise(*options, context); });
}

}  // namespace ridgeline::app
