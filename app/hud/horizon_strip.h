// A strip of the horizon: azimuth across, elevation up, and all that stands under it hidden.
//
// Keeps only its scale, so that it follows smoothly. Render thread, within ImguiLayer's frame.
#pragma once

#include <glm/glm.hpp>

#include "ridgeline/app/walk/stage.h"

namespace ridgeline::app {

// Elevations in degrees.
struct ElevationRange {
    float least = -5.0f;
    float most = 10.0f;
};
// The range in which the horizon of a scene and the level lie.
ElevationRange elevation_range(const HorizonScene& scene);

class HorizonStrip {
  public:
    // Its panel, with its right lower corner there; dt_s: since the last frame.
    void build(const HorizonScene& scene, const glm::vec2& right_bottom, const glm::vec2& size_px,
               float dt_s);

  private:
    ElevationRange range_;
    bool placed_ = false;
};

}  // namespace ridgeline::app
