// Where the sun's shadow maps lie: rings about the eye, each seen from the sun in a rectangle of its own.
//
// A pure function of view, sun and the terrain's bounds; what is drawn into the maps never enters, so that a
// map has the same texels whichever casters are left out. docs/shadows.md says how the rectangles are chosen.
// Any thread.
#pragma once

#include <array>
#include <cstddef>
#include <glm/glm.hpp>

#include "ridgeline/base/geometry.h"
#include "ridgeline/platform/camera.h"
#include "ridgeline/render/frame_uniforms.h"
#include "ridgeline/select/sun_view.h"
#include "ridgeline/shaders/shared/shadow_uniforms.h"

namespace ridgeline::render {

struct ShadowView {
    platform::Camera camera;
    Daylight daylight;
    // Bounds everything that may be drawn, in the drawn frame.
    Box terrain_m;
    // Between finest samples: shadows have no detail below it.
    double spacing_m = 1.0;
    int map_px = 2048;
};

struct ShadowCascade {
    // From metres relative to the eye: x, y in -1..1, z from 0 to 1 towards the sun.
    glm::dmat4 map_from_eye{1.0};
    // Distances from the eye: where the next cascade begins to take over, and where it has.
    double blend_m = 0.0;
    double end_m = 0.0;
    // Across and along the light axes, relative to the eye; empty where the view has no terrain in this ring.
    glm::dvec2 least_m{0.0};
    glm::dvec2 most_m{-1.0};
    glm::dvec2 texel_m{1.0};
};

struct ShadowCascades {
    static constexpr std::size_t kCount = shaders::kShadowCascades;

    // False while the sun is below the horizon.
    bool sun_is_up = false;
    select::SunAxes axes;
    std::array<ShadowCascade, kCount> rings{};

    // Whether a ring's map holds any of a box, which is relative to the eye.
    bool holds(std::size_t ring, const select::SunBox& box) const;
};

ShadowCascades shadow_cascades(const ShadowView& view);

// What the selection must know of them.
select::SunView sun_view(const ShadowCascades& cascades, select::CasterSet casters);

shaders::ShadowUniforms shadow_uniforms(const ShadowCascades& cascades, int map_px);

}  // namespace ridgeline::render
