// Hill-shading by Lambert's law with light from the north-west, as maps have had it since the 19th century:
// with light from below the sheet's edge, people see valleys as ridges.
#include "ridgeline/app/hud/map_ground.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ridgeline::app {
namespace {

constexpr int kMostCells = 32;
// A cell this large on the screen shows no corners.
constexpr float kCell_px = 3.5f;

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

// Heights of the vertices of a square of cells, and of one row of vertices around it: a vertex has the mean
// of the maxima that meet there.
class VertexHeights {
  public:
    VertexHeights(const SceneGround& ground, int cells) : stride_(cells + 3) {
        const int step = ground.cells / cells;
        for (int j = -1; j <= cells + 1; ++j)
            for (int i = -1; i <= cells + 1; ++i) {
                const int x = ground.from.x + i * step, y = ground.from.y + j * step;
                const int sum = cell(ground, x - 1, y - 1) + cell(ground, x, y - 1) + cell(ground, x - 1, y) +
                                cell(ground, x, y);
                heights_m_[place(i, j)] = ground.base_m + 0.25f * ground.step_m * static_cast<float>(sum);
            }
    }
    float at(int i, int j) const { return heights_m_[place(i, j)]; }

  private:
    std::size_t place(int i, int j) const { return static_cast<std::size_t>((j + 1) * stride_ + i + 1); }
    // Over the borders the nearest cell of the node that has the maxima, which may be wider than this one.
    static int cell(const SceneGround& ground, int x, int y) {
        const int most = ground.stride - 1;
        return ground
            .codes[static_cast<std::size_t>(std::clamp(y, 0, most) * ground.stride + std::clamp(x, 0, most))];
    }

    int stride_;
    std::array<float, (kMostCells + 3) * (kMostCells + 3)> heights_m_;
};

ImU32 shaded(float height_m, const glm::vec2& slope, const GroundTint& tint) {
    constexpr glm::vec3 kLight(-0.52058f, 0.52058f, 0.67675f);  // of unit length
    const glm::vec2 steep = slope * tint.steepened;
    const float cosine =
        (kLight.z - steep.x * kLight.x - steep.y * kLight.y) / std::sqrt(1.0f + glm::dot(steep, steep));
    const float light = 0.40f + std::max(cosine, 0.0f);
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
    const VertexHeights heights(ground, cells);
    const ImVec2 white = ImGui::GetFontTexUvWhitePixel();
    const float share = 1.0f / static_cast<float>(cells);
    const glm::vec2 cell_m = side_m * share;
    list.PrimReserve(6 * cells * cells, (cells + 1) * (cells + 1));
    const unsigned first = list._VtxCurrentIdx;
    for (int j = 0; j <= cells; ++j)
        for (int i = 0; i <= cells; ++i) {
            const glm::vec2 slope((heights.at(i + 1, j) - heights.at(i - 1, j)) / (2.0f * cell_m.x),
                                  (heights.at(i, j - 1) - heights.at(i, j + 1)) / (2.0f * cell_m.y));
            const ImVec2 at(north_west.x + (south_east.x - north_west.x) * static_cast<float>(i) * share,
                            north_west.y + (south_east.y - north_west.y) * static_cast<float>(j) * share);
            list.PrimWriteVtx(at, white, shaded(heights.at(i, j), slope, tint));
        }
    write_squares(list, cells, first);
}

}  // namespace ridgeline::app
