// A map from above, north up: how selection cut the ground about the eye into nodes, and what became of each.
//
// Keeps only where it looks, so that it follows the eye smoothly. Render thread, within ImguiLayer's frame.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "ridgeline/app/hud/horizon_scene.h"

namespace ridgeline::app {

// What the map shows: most of what is in the picture, the nodes about the eye, more of them, everything.
enum class MapRange { fitting, near, far, whole };
const char* name_of(MapRange range);

// A square of ground: metres east and north of the eye.
struct MapView {
    glm::vec2 centre_m{0.0f};
    float half_m = 1.0f;  // half its side
};
// Where a map of that range looks in the end. distances_m: scratch.
MapView map_view(const HorizonScene& scene, MapRange range, std::vector<float>& distances_m);

class NodeMap {
  public:
    // Its panel, with its right upper corner there; dt_s: since the last frame.
    void build(const HorizonScene& scene, MapRange range, const glm::vec2& right_top, float side_px,
               float dt_s);

  private:
    void follow(const HorizonScene& scene, MapRange range, float dt_s);

    MapView view_;
    bool placed_ = false;
    MapRange range_ = MapRange::fitting;
    std::vector<float> distances_m_;
};

}  // namespace ridgeline::app
