// Where suite `stress` goes: journeys that ask more of paging than any walk, over any terrain.
//
//   teleports   every half second another place, from 2 m to 500 m over the ground
//   turns       at four places 2 m over the ground, once around in a second
//   sprint      1 km/s along ridges, 30 m over them
//   dives       from 20 km to 2 m over the ground in three seconds, twice
//
// They follow from the terrain alone: the same on every run. Places lie on ground; where a terrain is too
// small for a journey, that is slower. Pure functions.
#pragma once

#include <string>
#include <vector>

#include "ridgeline/base/geometry.h"
#include "ridgeline/base/result.h"
#include "ridgeline/platform/camera_controller.h"
#include "ridgeline/platform/path.h"

namespace ridgeline::app {

struct StressPath {
    std::string name;
    platform::ResolvedPath path;
};

// Fails where there is no ground. bounds: of the ground; `ground` as platform::resolve takes it.
Result<std::vector<StressPath>> stress_paths(const Box& bounds, const platform::GroundFunction& ground);

}  // namespace ridgeline::app
