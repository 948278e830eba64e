// SIGINT, SIGTERM and SIGHUP as a flag that long work polls, so that it ends tidily; another one a second
// later or more ends the program at once. Those within the second are the same wish: a supervisor often
// signals a program and its group.
//
// The handlers are the process's: set up once, by main, before other threads start. Any thread may read the
// flag.
#pragma once

#include <atomic>

namespace ridgeline::app {

// Returns the flag, which lives as long as the program. A SIGHUP that the parent has
// ignored (nohup) stays ignored.
const std::atomic<bool>& watch_stop_signals();

// Makes writes past the limit of a file's size (ulimit -f) fail as writes to a full disk do, instead of
// ending the program on the spot.
void report_file_size_limit();

}  // namespace ridgeline::app
