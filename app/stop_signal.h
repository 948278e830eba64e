// SIGINT and SIGTERM as a flag that long work polls, so that it ends tidily; a second one ends the program at
// once.
//
// The handlers are the process's: set up once, by main, before other threads start. Any thread may read the
// flag.
#pragma once

#include <atomic>

namespace ridgeline::app {

// Returns the flag, which lives as long as the program.
const std::atomic<bool>& watch_stop_signals();

}  // namespace ridgeline::app
