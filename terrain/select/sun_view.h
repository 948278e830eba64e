// What selection knows of the sun: from where it shines, whose shadows are wanted, and how far from a place
// its shadow is looked up.
//
// Light axes: across the sun's azimuth (level), along it (up the picture that the sun has of the ground), and
// towards the sun. A ray of sunlight keeps its first two coordinates. Plain values; copy them freely.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>

#include "ridgeline/base/geometry.h"
#include "ridgeline/base/units.h"

namespace ridgeline::select {

// Which nodes cast shadows.
enum class CasterSet : std::uint8_t {
    none,  // no shadows are drawn
    pvs,   // those in view and those whose shadows can reach what is in view
    all,   // every node all around the eye
};

// Unit vectors, perpendicular to one another.
struct SunAxes {
    glm::dvec3 across{1.0, 0.0, 0.0};
    glm::dvec3 along{0.0, 1.0, 0.0};
    glm::dvec3 towards{0.0, 0.0, 1.0};
};
// azimuth: clockwise from north. With the sun in the zenith the azimuth still says how the axes lie.
SunAxes sun_axes(Angle azimuth, Angle elevation);

// A box along the light axes, relative to the eye: x across, y along, z towards the sun, metres.
using SunBox = Box;
SunBox sun_box(const SunAxes& axes, const glm::dvec3& eye_m, const Box& box);

// From a distance on, how far a shadow's lookup strays from the place that it is for: by filtering and by
// offsets against acne.
struct ShadowReach {
    double from_m = 0.0;
    glm::dvec2 aside_m{0.0};  // across and along
    double down_m = 0.0;      // away from the sun
};

struct SunView {
    static constexpr std::size_t kMostReaches = 8;

    CasterSet casters = CasterSet::none;
    SunAxes axes;
    // By distance, growing; the first from 0.
    std::array<ShadowReach, kMostReaches> reaches{};
    std::size_t reach_count = 0;

    // The last one that begins within `distance_m`.
    const ShadowReach& reach_at(double distance_m) const;
};

}  // namespace ridgeline::select
