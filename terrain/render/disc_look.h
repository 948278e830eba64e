// The disc's surface as the CPU knows it: the same functions as the vertex shader's, over the page table and
// the tiles in RAM. For the eye, which must stay above it, and for the tests.
//
// A view of a HeightTexture and a pager for the length of a frame. Render thread.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>

#include "ridgeline/pager/pager.h"
#include "ridgeline/render/height_texture.h"
#include "ridgeline/select/view.h"

namespace ridgeline::render {

// How high a surface stands within so many metres of the eye; metres over it. Its triangles are larger than
// the reach, so its highest point there is seldom elsewhere than at these nine.
template <class Look>
double highest_about_eye_m(const Look& look, const select::EyeFrame& eye_frame, double reach_m) {
    const glm::dvec2 eye = glm::dvec2(eye_frame.cell) + glm::dvec2(eye_frame.cell_rest);
    const glm::dvec2 reach = reach_m / glm::dvec2(eye_frame.spacing_m);
    double highest_m = look.height_m(eye);
    for (int i = 0; i < 9; ++i)
        if (i != 4)
            highest_m = std::max(highest_m, look.height_m(eye + glm::dvec2(i % 3 - 1, i / 3 - 1) * reach));
    return highest_m;
}

class DiscLook {
  public:
    // heights: after prepare() or look_from() for the frame's eye.
    DiscLook(const HeightTexture& heights, const pager::Pager& pager, const select::EyeFrame& eye)
        : heights_(heights), pager_(pager), eye_(eye) {}

    // Metres over the eye, with exaggeration, at a place of the lattice (column, row).
    double height_m(const glm::dvec2& place) const;
    // How high the surface stands within so many metres of the eye; metres over it.
    double highest_about_eye_m(double reach_m) const {
        return render::highest_about_eye_m(*this, eye_, reach_m);
    }

    // As shaders/lib/disc.h asks for them.
    std::int32_t texel(const glm::ivec2& at, std::uint32_t slot) const;
    std::uint32_t page(const glm::ivec3& at) const { return heights_.tiles().page(at); }
    float fade(std::uint32_t slot) const { return heights_.tiles().fade(slot); }

  private:
    double vertex_quanta(const glm::ivec2& cell, int ring) const;

    const HeightTexture& heights_;
    const pager::Pager& pager_;
    select::EyeFrame eye_;
};

}  // namespace ridgeline::render
