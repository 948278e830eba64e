// Heights of a made-up terrain as the surfaces that sample them have them, with all tiles there.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <glm/glm.hpp>

#include "ridgeline/shaders/lib/disc.h"

namespace ridgeline::test {

// Samples of a level are the function's there.
// The slot that a page names is its level, for tiles as large as the terrain.
struct WholeHeights {
    static constexpr int kBits = 13, kFinest = 7;
    std::int32_t (*quanta)(int column, int row);

    static std::int32_t filtered(const WholeHeights& heights, const glm::ivec2& at, int coarseness) {
        if (coarseness == 0) return 16 * heights.quanta(at.x, at.y);
        std::int32_t sum = 0;
        for (int y = -1; y <= 1; ++y)
            for (int x = -1; x <= 1; ++x)
                sum += (2 - std::abs(x)) * (2 - std::abs(y)) *
                       heights.quanta((at.x + x) << coarseness, (at.y + y) << coarseness);
        return sum;
    }
    std::int32_t texel(const glm::ivec2& at, shaders::uint slot) const {
        return 2 * filtered(*this, at - shaders::kHeightApron, static_cast<int>(slot)) + 1;
    }
    // Of one column and row of tiles; the layer is the level.
    shaders::uint page(const glm::ivec3& at) const {
        const auto coarseness = static_cast<shaders::uint>(kFinest - at.z);
        return (coarseness << shaders::kPageCoarsenessShift) | (coarseness + 1);
    }
    float fade(shaders::uint) const { return 0.0f; }
};

inline shaders::DiscUniforms uniforms_at(const glm::dvec2& eye, float above) {
    shaders::DiscUniforms disc{};
    const glm::dvec2 cell = glm::floor(eye);
    disc.eye_cell_and_size = glm::ivec4(glm::ivec2(cell), 8193, 8193);
    disc.table = glm::ivec4(WholeHeights::kFinest, 6, 6, WholeHeights::kBits);
    disc.eye = glm::vec4(eye - cell, 0.0, 0.0);
    disc.middle = glm::vec4(glm::vec2(eye - cell), above, 0.0f);
    return disc;
}

inline std::int32_t rough(int column, int row) {
    const double u = column, v = row;
    return static_cast<std::int32_t>(900.0 * std::sin(u * 0.011) * std::cos(v * 0.017) +
                                     120.0 * std::sin(u * 0.13 + v * 0.09) +
                                     20.0 * std::sin(u * 1.7) * std::sin(v * 1.3));
}

}  // namespace ridgeline::test
