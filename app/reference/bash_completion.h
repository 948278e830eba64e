// What bash completes of a command line: commands, options, the values that options offer, and files. Pure; any
// thread.
#pragma once

#include <string>

#include "ridgeline/app/usage.h"

namespace ridgeline::app {

// A script that bash-completion loads, or that may be sourced; needs bash alone.
std::string bash_completion(const Usage& usage);

}  // namespace ridgeline::app
