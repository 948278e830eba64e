// A walk from its first frame to its last: what `ridgeline walk` runs.
//
// The calling thread becomes the render thread. Everything that can be wrong with what was asked for (paths,
// places for pictures, caches) is found before the first frame. docs/threads.md shows who does what
// meanwhile.
#pragma once

#include "ridgeline/app/commands/walk_options.h"
#include "ridgeline/base/result.h"

namespace ridgeline::app {

Result<void> run_walk(const WalkOptions& options);

}  // namespace ridgeline::app
