// ridgeline: the one program. Parses the command line, runs one subcommand, and turns what comes back into an
// exit status (0 done, 1 the run failed, 2 wrong usage) and, if it fails, one line on stderr.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>

#include "ridgeline/app/command.h"
#include "ridgeline/app/stop_signal.h"
#include "ridgeline/base/log.h"

namespace {

using ridgeline::Error;
using ridgeline::Result;

constexpr int kRunFailed = 1;
constexpr int kWrongUsage = 2;

int fail(std::string message, int status) {
    // One line, whatever a library put into its message.
    for (char& c : message)
        if (c == '\n' || c == '\r') c = ' ';
    std::fprintf(stderr, "ridgeline: error: %s\n", message.c_str());
    return status;
}

struct GlobalOptions {
    bool quiet = false;
    std::string log_level = "warn";
};

void add_global_options(CLI::App& syntax, GlobalOptions& options) {
    syntax.add_flag("--quiet", options.quiet, "No progress and no summaries; errors and results only");
    ridgeline::app::add_choice(syntax, "--log-level", options.log_level,
                               {{"warn", "trace", "debug", "info", "error", "off"}, {}},
                               "What is logged on stderr");
    syntax.get_formatter()->label("SUBCOMMAND", "COMMAND ...");
    syntax.set_version_flag("--version", "ridgeline " RIDGELINE_VERSION);
    syntax.footer(
        "Example:\n  ridgeline synth alps.tif --size 2049\n  ridgeline build alps.tif --out alps.terrain\n"
        "  ridgeline walk alps.terrain\n\nridgeline COMMAND --help says more of each.");
}

// "--out is required" to "--out: is required", so that every line reads WHAT: WHY.
std::string usage_error(std::string message) {
    if (message.find(": ") != std::string::npos) return message;
    for (const char* verb : {" is required", " excludes "})
        if (const auto at = message.find(verb); at != std::string::npos) return message.insert(at, ":");
    return "command line: " + message;
}

Result<const ridgeline::app::Run*> chosen_run(const CLI::App& syntax,
                                              const ridgeline::app::Program& program) {
    const ridgeline::app::Run* run = program.chosen();
    const auto strange = syntax.remaining(true);
    const std::string help =
        "see ridgeline " + (run ? syntax.get_subcommands().front()->get_name() + " " : "") + "--help";
    if (!strange.empty()) {
        const bool option = strange.front().starts_with('-');
        return Error{strange.front() + ": " + (run || option ? "not expected" : "no such command") + ", " +
                     help};
    }
    if (!run) return Error{"no command: " + help};
    return run;
}

int run_program(int argc, char** argv) {
    ridgeline::app::report_file_size_limit();
    CLI::App syntax("Walks terrain far larger than memory, in real time.", "ridgeline");
    syntax.require_subcommand(0, 1);
    syntax.allow_extras();  // chosen_run says better what is wrong with them
    GlobalOptions options;
    add_global_options(syntax, options);
    ridgeline::app::Program program(syntax);
    ridgeline::app::add_synth(program);
    ridgeline::app::add_build(program);
    ridgeline::app::add_info(program);
    ridgeline::app::add_verify(program);
    ridgeline::app::add_height(program);
    ridgeline::app::add_walk(program);
    ridgeline::app::add_bench(program);
    try {
        syntax.parse(argc, argv);
    } catch (const CLI::Success& asked) {
        // Help on a command that does not exist would be everybody's help, and no word of what is wrong.
        if (!program.chosen() && !syntax.remaining().empty())
            return fail(chosen_run(syntax, program).error().message, kWrongUsage);
        return syntax.exit(asked);
    } catch (const CLI::Error& error) {
        return fail(usage_error(error.what()), kWrongUsage);
    }
    const auto run = chosen_run(syntax, program);
    if (!run) return fail(run.error().message, kWrongUsage);
    if (const auto logging = ridgeline::set_up_logging(options.log_level); !logging)
        return fail(logging.error().message, kWrongUsage);

    const auto result = (**run)({options.quiet});
    if (!result) return fail(result.error().message, kRunFailed);
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
        return fail("standard output: cannot be written", kRunFailed);
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return run_program(argc, argv);
    } catch (const std::bad_alloc&) {
        return fail("memory: there is not enough of it", kRunFailed);
    } catch (const std::exception& unexpected) {
        return fail(std::string("unexpected: ") + unexpected.what(), kRunFailed);
    }
}
