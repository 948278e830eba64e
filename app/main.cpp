// ridgeline: the one program. Parses the command line, runs one subcommand, and turns what comes back into an
// exit status (0 done, 1 the run failed, 2 wrong usage) and, if it fails, one line on stderr.
#include <cstdio>
#include <exception>
#include <string>

#include "ridgeline/app/command.h"
#include "ridgeline/app/program.h"
#include "ridgeline/app/stop_signal.h"
#include "ridgeline/base/log.h"

namespace {

constexpr int kRunFailed = 1;
constexpr int kWrongUsage = 2;

int fail(std::string message, int status) {
    // One line, whatever a library put into its message.
    for (char& c : message)
        if (c == '\n' || c == '\r') c = ' ';
    std::fprintf(stderr, "ridgeline: error: %s\n", message.c_str());
    return status;
}

int run_program(int argc, char** argv) {
    ridgeline::app::report_file_size_limit();
    ridgeline::app::GlobalOptions options;
    ridgeline::app::Program program(ridgeline::app::program_text());
    ridgeline::app::add_everything(program, options);
    const auto run = program.parse(argc, argv);
    if (!run) return fail(run.error().message, kWrongUsage);
    if (*run == nullptr) return 0;  // help was asked for
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
