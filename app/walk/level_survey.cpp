#include "ridgeline/app/walk/level_survey.h"

#include <algorithm>

#include "ridgeline/shaders/lib/quadtree.h"

namespace ridgeline::app {
namespace {

LevelCell cell_at(const shaders::QuadtreeUniforms& view, const glm::ivec2& corner, int level,
                  const io::TerrainInfo& info, const glm::dvec3& eye_m) {
    const glm::dvec2 spacing_m(info.spacing_x_m, info.spacing_y_m);
    LevelCell cell;
    cell.corner_m = {info.west_m + corner.x * spacing_m.x - eye_m.x,
                     info.north_m - corner.y * spacing_m.y - eye_m.y};
    cell.side_m = spacing_m * static_cast<double>(1 << shaders::cell_shift(view, level));
    cell.level = level;
    cell.in_view = shaders::cell_in_view(view, corner, level);
    return cell;
}

}  // namespace

void survey_levels(const render::LevelMatrix& matrix, const io::TerrainInfo& info, const glm::dvec3& eye_m,
                   LevelScene& scene) {
    scene.cells.clear();
    scene.drawn.fill(0);
    scene.finest_quad_m = static_cast<float>(std::max(info.spacing_x_m, info.spacing_y_m));
    for (std::size_t i = 0; i < matrix.cells.size(); ++i) {
        const shaders::QuadtreeBlock& block = matrix.blocks[i / shaders::kQuadtreeEntries];
        const glm::ivec2 place = shaders::entry_place(static_cast<int>(i % shaders::kQuadtreeEntries));
        const int level = matrix.cells[i].level;
        if (!shaders::has_entry(block, place) || !shaders::is_corner(block, place, level)) continue;
        scene.cells.push_back(
            cell_at(matrix.view, shaders::entry_corner(matrix.view, block, place), level, info, eye_m));
        if (scene.cells.back().in_view) ++scene.drawn[static_cast<std::size_t>(level)];
    }
}

}  // namespace ridgeline::app
