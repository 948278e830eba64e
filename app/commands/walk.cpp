// ridgeline walk: shows a terrain store, in a window or off-screen.
#include <memory>

#include "ridgeline/app/command.h"
#include "ridgeline/app/commands/walk_options.h"
#include "ridgeline/app/walk/walk.h"

namespace ridgeline::app {

void add_walk(Program& program) {
    const Syntax syntax =
        program.add("walk", "Walk a terrain store",
                    "ridgeline walk alps.terrain\n"
                    "  ridgeline walk alps.terrain --headless --path orbit --frames 600 --telemetry walk\n"
                    "  ridgeline walk alps.terrain --headless --frames 1 --shot 0:alps.png");
    auto options = std::make_shared<WalkOptions>();
    add_walk_options(syntax, *options);
    program.runs("walk", [options](const RunContext& context) {
        options->quiet = context.quiet;
        return run_walk(*options);
    });
}

}  // namespace ridgeline::app
