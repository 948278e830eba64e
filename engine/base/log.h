// Logging to stderr, at a level that the program sets once. Errors that end a run are printed by app/main
// alone.
//
// A line is text that the caller has put together; the library that writes it (spdlog) stays behind this
// header, for whoever included it took seconds longer to compile. Any thread may log; levels are set before
// others start.
#pragma once

#include <string_view>

#include "ridgeline/base/result.h"

namespace ridgeline {

enum class LogLevel { trace, debug, info, warn, error, off };

// level: trace, debug, info, warn, error or off.
Result<void> set_up_logging(std::string_view level);

void set_log_level(LogLevel level);
// Ask before putting together a line that comes often.
bool is_logged(LogLevel level);
void log_line(LogLevel level, std::string_view text);

}  // namespace ridgeline
