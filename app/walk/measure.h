// Measuring on the ground: from a place in the picture to a ray over the terrain, from two points to what
// lies between them, and back into the picture.
//
// Points are true: metres in the store's reference system, heights without exaggeration. The picture's are
// those of the drawn frame (select/view.h), and a VerticalScale is what lies between. Exaggeration only
// scales heights, so a ray stays a ray. Plain values and pure functions; any thread.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "ridgeline/base/units.h"
#include "ridgeline/platform/camera.h"
#include "ridgeline/platform/input.h"

namespace ridgeline::app {

struct VerticalScale {
    double offset_m = 0.0;  // the height that is drawn as it is
    double exaggeration = 1.0;

    double drawn_m(double true_m) const { return offset_m + (true_m - offset_m) * exaggeration; }
    double true_m(double drawn_m) const { return offset_m + (drawn_m - offset_m) / exaggeration; }
};

struct GroundRay {
    glm::dvec3 origin_m{0.0};
    glm::dvec3 direction{0.0, 0.0, -1.0};  // of any length
};

// Through a place in the picture: 0 to 1 to the right, 0 to 1 downwards. The camera is the drawn one.
GroundRay ray_through(const platform::Camera& camera, const VerticalScale& scale,
                      const glm::dvec2& picture_place);
// Where a point appears in the picture, in the same measure; nothing behind the near plane.
std::optional<glm::dvec2> picture_place(const platform::Camera& camera, const VerticalScale& scale,
                                        const glm::dvec3& point_m);

// Heights along the straight line between two points, evenly spread, both ends included. What has no height
// is not a number.
using HeightProfile = std::vector<float>;
// As many samples as the data can tell apart, but no more than a graph can show.
std::size_t profile_samples(const glm::dvec3& from_m, const glm::dvec3& to_m, double spacing_m);

struct LineFigures {
    double level_m = 0.0;     // distance on the map
    double straight_m = 0.0;  // through the air
    Angle bearing;            // of the second point from the first, clockwise from the grid's north
    double rise_m = 0.0;
    // Of the profile; the sums of all ways up and all ways down along it.
    double ascent_m = 0.0, descent_m = 0.0;
    double lowest_m = 0.0, highest_m = 0.0;
};
LineFigures line_figures(const glm::dvec3& from_m, const glm::dvec3& to_m, std::span<const float> profile);

struct Click {
    platform::MouseButton button = platform::MouseButton::left;
    glm::dvec2 at_px{0.0};  // as Input::mouse_position_px
};

// Tells a click from holding a button to look around.
class ClickWatch {
  public:
    // The click that ended in this frame.
    std::optional<Click> update(const platform::Input& input);

  private:
    struct Press {
        bool down = false;
        double moved_px = 0.0;
        glm::dvec2 at_px{0.0};
    };
    std::array<Press, static_cast<std::size_t>(platform::MouseButton::count)> presses_;
};

}  // namespace ridgeline::app
