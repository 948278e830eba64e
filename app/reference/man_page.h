// The manual page of a command line, in the language of man(7). Pure; any thread.
#pragma once

#include <string>

#include "ridgeline/app/usage.h"

namespace ridgeline::app {

// One page, section 1, of all commands. The same bytes for the same usage: no date.
std::string man_page(const Usage& usage);

}  // namespace ridgeline::app
