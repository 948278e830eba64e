// The stage (terrain/stage) as the program speaks of it: its names are the walk's own.
#pragma once

#include "ridgeline/stage/eye_lift.h"
#include "ridgeline/stage/horizon_scene.h"
#include "ridgeline/stage/terrain_stage.h"
#include "ridgeline/stage/tile_wants.h"

namespace ridgeline::app {
using namespace ridgeline::stage;
}  // namespace ridgeline::app
