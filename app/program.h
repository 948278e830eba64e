// The whole command line: what the program says of itself, and all that it takes. For main, and for what is
// generated from it (app/reference).
#pragma once

#include <string>

#include "ridgeline/app/command.h"

namespace ridgeline::app {

struct GlobalOptions {
    bool quiet = false;
    std::string log_level;  // one of those offered
};

ProgramText program_text();
// Every subcommand, and what all of them take; `options` must live as long as the program.
void add_everything(Program& program, GlobalOptions& options);

}  // namespace ridgeline::app
