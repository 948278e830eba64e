// Hill-shading by Lambert's law with light from the north-west, as maps have had it since the 19th century:
// with light from below the sheet's edge, people see valleys as ridges.
#include "ridgeline/app/hud/map_ground.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ridgeline::app {
namespace {

constexpr int kMostCells = 64;
// A cell this large on the screen shows no corners.
constexpr float kCell_px = 3.0f;

// Paler with height, and never so bright that the colours over it are lost.
constexpr std::array<glm::vec3, 5> kTints = {{{0.30f, 0.37f, 0.33f},
                                              {0.40f, 0.45f, 0.35f},
                                              {0.53f, 0.50f, 0.40f},
                                              {0.62f, 0.58f, 0.52f},
                                              {0.84f, 0.85f, 0.87f}}};

glm::vec3 tint_at(float share) {
    const float at = std::clamp(share, 0.0f, 1.0f) * static_cast<float>(kTints.size() - 1);
    const std::size_t below = std::min(static_cast<std::size_t>(at), kTints.size() - 2);
    return glm::mix(kTints[below], kTints[below + 1], at - static_cast<float>(below));
}

// The maxima as a function of vertices: the mean of the cells that meet there.
class CellHeights {
  public:
    // step: cells that are taken as one.
    CellHeights(const SceneGround& ground, int step) : ground_(ground), step_(step) {}

    float at_vertex(int i, int j) const {
        const float sum = cell(i * step_ - 1, j * step_ - 1) + cell(i * step_, j * step_ - 1) +
                          cell(i * step_ - 1, j * step_) + cell(i * step_, j * step_);
        return ground_.base_m + 0.25f * sum * ground_.step_m;
    }

  private:
    // Over the borders the nearest cell of the node that has the maxima, which may be wider than this one.
    float cell(int x, int y) const {
        const int most = ground_.stride - 1;
        const auto column = static_cast<std::size_t>(std::clamp(ground_.from.x + x, 0, most));
        const auto row = static_cast<std::size_t>(std::clamp(ground_.from.y + y, 0, most));
        return ground_.codes[row * static_cast<std::size_t>(ground_.stride) + column];
    }

    const SceneGround& ground_;
    int step_;
};

ImU32 shaded(float height_m, const glm::vec2& slope, const GroundTint& tint) {
    static const glm::vec3 kLight = glm::normalize(glm::vec3(-1.0f, 1.0f, 1.3f));
    const glm::vec3 normal = glm::normalize(glm::vec3(-slope * tint.steepened, 1.0f));
    const float light = 0.40f + 1.0f * std::max(glm::dot(normal, kLight), 0.0f);
    const float range_m = std::max(tint.highest_m - tint.lowest_m, 1.0f);
    const glm::vec3 color =
        glm::clamp(tint_at((height_m - tint.lowest_m) / range_m) * light, glm::vec3(0.0f), glm::vec3(1.0f));
    const auto byte = [](float share) { return static_cast<int>(share * 255.0f + 0.5f); };
    return IM_COL32(byte(color.x), byte(color.y), byte(color.z), 255);
}

// A power of two, so that vertices of neighbours meet.
int cells_shown(const SceneGround& ground, float side_px) {
    int cells = 1;
    while (2 * cells <= std::min(ground.cells, kMostCells) && static_cast<float>(cells) * kCell_px < side_px)
        cells *= 2;
    return cells;
}

void write_squares(ImDrawList& list, int cells, unsigned first) {
    const auto row = static_cast<unsigned>(cells + 1);
    for (unsigned j = 0; j < row - 1; ++j)
        for (unsigned i = 0; i < row - 1; ++i) {
            const unsigned corner = first + j * row + i;
            for (const unsigned vertex :
                 {corner, corner + 1, corner + row + 1, corner, corner + row + 1, corner + row})
                list.PrimWriteIdx(static_cast<ImDrawIdx>(vertex));
        }
}

}  // namespace

void draw_ground(ImDrawList& list, const SceneGround& ground, const glm::vec2& side_m,
                 const ImVec2& north_west, const ImVec2& south_east, const GroundTint& tint) {
    if (ground.cells == 0) return;
    const int cells = cells_shown(ground, south_east.x - north_west.x);
    const CellHeights heights(ground, ground.cells / cells);
    const ImVec2 white = ImGui::GetFontTexUvWhitePixel();
    const float share = 1.0f / static_cast<float>(cells);
    const glm::vec2 cell_m = side_m * share;
    list.PrimReserve(6 * cells * cells, (cells + 1) * (cells + 1));
    const unsigned first = list._VtxCurrentIdx;
    for (int j = 0; j <= cells; ++j)
        for (int i = 0; i <= cells; ++i) {
            const glm::vec2 slope(
                (heights.at_vertex(i + 1, j) - heights.at_vertex(i - 1, j)) / (2.0f * cell_m.x),
                (heights.at_vertex(i, j - 1) - heights.at_vertex(i, j + 1)) / (2.0f * cell_m.y));
            const ImVec2 at(north_west.x + (south_east.x - north_west.x) * static_cast<float>(i) * share,
                            north_west.y + (south_east.y - north_west.y) * static_cast<float>(j) * share);
            list.PrimWriteVtx(at, white, shaded(heights.at_vertex(i, j), slope, tint));
        }
    write_squares(list, cells, first);
}

}  // namespace ridgeline::app
