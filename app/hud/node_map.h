// A map from above, north up: how selection cut the ground about the eye into nodes, and what became of each;
// or the cells into which the quadtree divided it, by level.
//
// Keeps only where it looks, so that it follows the eye smoothly. Render thread, within ImguiLayer's frame.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "ridgeline/app/hud/horizon_scene.h"
#include "ridgeline/app/hud/level_scene.h"

namespace ridgeline::app {

// What the map shows: most of what is in the picture, the nodes about the eye, more of them, everything.
enum class MapRange { fitting, near, far, whole };
const char* name_of(MapRange range);
// What of: what became of the nodes, the quadtree's levels where it is drawn.
enum class MapTheme { fates, levels };

// A square of ground: metres east and north of the eye.
struct MapView {
    glm::vec2 centre_m{0.0f};
    float half_m = 1.0f;  // half its side
};
// Where a map of that range looks in the end. distances_m: scratch.
MapView map_view(const HorizonScene& scene, MapRange range, std::vector<float>& distances_m);

// Where its panel stands.
struct MapPlace {
    glm::vec2 right_top_px{0.0f};
    float side_px = 200.0f;         // of the map itself
    float most_height_px = 400.0f;  // of the panel: where it has no room, the legend is shorter, or left out
};

struct MapContent {
    const HorizonScene& scene;
    const LevelScene* levels = nullptr;  // null: what became of the nodes
    MapRange range = MapRange::fitting;
};

class NodeMap {
  public:
    // dt_s: since the last frame.
    void build(const MapContent& content, const MapPlace& place, float dt_s);

  private:
    void follow(const HorizonScene& scene, MapRange range, float dt_s);

    MapView view_;
    bool placed_ = false;
    MapRange range_ = MapRange::fitting;
    std::vector<float> distances_m_;
};

}  // namespace ridgeline::app
