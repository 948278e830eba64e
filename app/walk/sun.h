// Where the sun stands over a place at a time. Pure; any thread.
#pragma once

#include <chrono>
#include <glm/glm.hpp>

#include "ridgeline/render/frame_uniforms.h"

namespace ridgeline::app {

// longitude_latitude in degrees. Good to a hundredth of a degree or so from 1950 to 2050; refraction is left
// out, and the azimuth counts from true north.
render::Daylight daylight_at(std::chrono::sys_seconds time, const glm::dvec2& longitude_latitude);

}  // namespace ridgeline::app
