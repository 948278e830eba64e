#include "ridgeline/app/program.h"

namespace ridgeline::app {

ProgramText program_text() {
    return {.name = "ridgeline",
            .what = "Walks terrain far larger than memory, in real time.",
            .version = RIDGELINE_VERSION,
            .footer =
                "Example:\n  ridgeline synth alps.tif --size 2049\n  ridgeline build alps.tif --out "
                "alps.terrain\n"
                "  ridgeline walk alps.terrain\n\nridgeline COMMAND --help says more of each."};
}

void add_everything(Program& program, GlobalOptions& options) {
    program.syntax().flag("--quiet", options.quiet, "No progress and no summaries; errors and results only");
    add_choice(program.syntax(), "--log-level", options.log_level,
               {"warn", "trace", "debug", "info", "error", "off"}, "What is logged on stderr");
    add_synth(program);
    add_build(program);
    add_info(program);
    add_verify(program);
    add_height(program);
    add_walk(program);
    add_bench(program);
    add_report(program);
}

}  // namespace ridgeline::app
