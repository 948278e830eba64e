// Fills the map's level matrix from what the quadtree drew. Pure; allocates nothing once the scene has seen
// its most cells.
#pragma once

#include "ridgeline/app/hud/level_scene.h"
#include "ridgeline/io/terrain_info.h"
#include "ridgeline/render/level_matrix.h"

namespace ridgeline::app {

// eye_m: about which the map is drawn, which has moved on since.
void survey_levels(const render::LevelMatrix& matrix, const io::TerrainInfo& info, const glm::dvec3& eye_m,
                   LevelScene& scene);

}  // namespace ridgeline::app
