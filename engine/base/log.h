// Logging: spdlog to stderr, set up once by the program. Errors that end a run are printed by app/main alone.
#pragma once

#include <spdlog/spdlog.h>

#include <string_view>

#include "ridgeline/base/result.h"

namespace ridgeline {

// level: trace, debug, info, warn, error or off.
Result<void> set_up_logging(std::string_view level);

}  // namespace ridgeline
