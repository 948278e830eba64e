// From camera, light and terrain to the uniform block of a frame. Pure; any thread.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

#include "ridgeline/base/units.h"
#include "ridgeline/io/terrain_info.h"
#include "ridgeline/platform/camera.h"
#include "ridgeline/select/view.h"
#include "ridgeline/shaders/shared/frame_uniforms.h"

namespace ridgeline::render {

struct Daylight {
    // North-west, where relief maps have their light, so that the eye does not take valleys for ridges.
    Angle sun_azimuth = Angle::from_degrees(315.0);  // clockwise from north
    Angle sun_elevation = Angle::from_degrees(38.0);
};

// Unit vector towards the sun.
glm::dvec3 sun_direction(const Daylight& daylight);

// What stands for the sky where a plain colour is wanted: haze is off then, and no ground has exactly this
// colour.
struct PlainBackground {
    std::uint8_t red = 0, green = 0, blue = 0;
};

struct FrameView {
    platform::Camera camera;  // its eye in the drawn frame (select/view.h)
    select::EyeFrame eye;     // of the selection that is drawn
    double exaggeration = 1.0;
    Daylight daylight;
    std::optional<PlainBackground> background;
    int finer_octaves = 0;  // of the eye's lattice, than the source's
};

shaders::FrameUniforms frame_uniforms(const FrameView& view, const io::TerrainInfo& info);

}  // namespace ridgeline::render
