// What the map shows of the quadtree: its cells from above, by level. Plain values; whoever fills them keeps
// the memory from frame to frame.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "ridgeline/io/grid.h"
#include "ridgeline/shaders/shared/quadtree_blocks.h"

namespace ridgeline::app {

struct LevelCell {
    glm::vec2 corner_m{0.0f};  // north-western: east and north of the eye
    glm::vec2 side_m{0.0f};    // to the east, to the south
    int level = 0;
    bool in_view = false;  // else it is not drawn
};

struct LevelScene {
    // The coarsest blocks have cells coarser than themselves.
    static constexpr std::size_t kLevels = io::Grid::kMaxLevels + shaders::kQuadtreeDepth;

    std::vector<LevelCell> cells;
    std::array<std::uint32_t, kLevels> drawn{};  // by level
    float finest_quad_m = 1.0f;                  // a quad's longer side at level 0
};

}  // namespace ridgeline::app
