// How high the quadtree's surface stands near the eye, as the CPU can know it without the GPU's levels: it
// works out the level that is asked for at a place, by the shader's own functions. Neighbours may have made a
// cell finer, or its border coarser, so the height is that of the highest surface that may be drawn there;
// where the eye is near, all are next to the same. Borders still coarser, of neighbours that have turned farther, do not
// count.
//
// A view of a frame's textures and blocks for the length of a frame. Render thread.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "ridgeline/render/asked_block.h"
#include "ridgeline/render/disc_look.h"
#include "ridgeline/render/quadtree_surface.h"

namespace ridgeline::render {

class QuadtreeLook {
  public:
    // heights, quadtree: turned to the frame. disc: of the same frame.
    QuadtreeLook(const DiscLook& disc, const HeightTexture& heights, QuadtreeSurface& quadtree,
                 const pager::Pager& pager, const select::EyeFrame& eye)
        : disc_(disc), heights_(heights), quadtree_(quadtree), pager_(pager), eye_(eye) {}

    // Metres over the eye, with exaggeration, at a place of the lattice (column, row).
    double height_m(const glm::dvec2& place) const;
    // How high the surface stands within so many metres of the eye; metres over it.
    double highest_about_eye_m(double reach_m) const {
        return render::highest_about_eye_m(*this, eye_, reach_m);
    }

  private:
    double triangle_m(const glm::dvec2& place, int level, float turned) const;

    DiscLook disc_;
    const HeightTexture& heights_;
    QuadtreeSurface& quadtree_;
    const pager::Pager& pager_;
    select::EyeFrame eye_;

    // The block that was last asked about: places asked for lie together.
    struct AskedHere {
        int block;
        AskedBlock entries;
    };
    mutable std::optional<AskedHere> asked_;
};

}  // namespace ridgeline::render
