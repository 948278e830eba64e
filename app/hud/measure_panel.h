// What was measured on the ground: marks and a line over the picture, figures and a height profile in a
// panel.
//
// Knows points and heights only; the walk fills a MeasureScene each frame. Render thread, within ImguiLayer's
// frame.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <span>

#include "ridgeline/app/walk/measure.h"

namespace ridgeline::app {

struct MeasureScene {
    platform::Camera camera;  // with which the picture was drawn
    VerticalScale scale;
    // The first where one was clicked, the second where a line was; true heights.
    std::array<std::optional<glm::dvec3>, 2> points_m;
    std::array<std::optional<glm::dvec2>, 2> degrees;  // longitude, latitude
    std::span<const float> profile;                    // between two points
};

class MeasurePanel {
  public:
    // right_bottom_px: where the panel's lower right corner stands.
    void build(const MeasureScene& scene, const glm::vec2& right_bottom_px);

  private:
    // On the ground.
    static glm::dvec3 point_at(const MeasureScene& scene, std::size_t sample);
    void draw_on_ground(const MeasureScene& scene);
    void draw_drape(const MeasureScene& scene);
    void build_points(const MeasureScene& scene) const;
    void build_line(const LineFigures& line) const;
    // Sets pointed_at_.
    void build_graph(const MeasureScene& scene, const LineFigures& line);

    // The profile's sample under the mouse, as of the last frame.
    std::optional<std::size_t> pointed_at_;
};

// The least of 1, 2, 5 times a power of ten with which `range` has no more than `most` steps.
double round_step(double range, int most);

}  // namespace ridgeline::app
