// The ground of a map from above: hill-shaded, tinted by height, from the maxima that the horizon goes by.
//
// Each node is a small grid of smoothly coloured triangles, as fine as the map can show and its maxima know.
#pragma once

#include <imgui.h>

#include <glm/glm.hpp>

#include "ridgeline/app/walk/stage.h"

namespace ridgeline::app {

// Heights over the eye, between which the tint runs.
struct GroundTint {
    float lowest_m = 0.0f;
    float highest_m = 1.0f;
    float steepened = 1.0f;  // slopes are shaded as if so many times as steep
};

// north_west, south_east: where the node lies on the screen.
void draw_ground(ImDrawList& list, const SceneGround& ground, const glm::vec2& side_m,
                 const ImVec2& north_west, const ImVec2& south_east, const GroundTint& tint);

}  // namespace ridgeline::app
