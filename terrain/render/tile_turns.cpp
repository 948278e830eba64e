#include "ridgeline/render/tile_turns.h"

#include <algorithm>

namespace ridgeline::render {
namespace {

// Between the heights of all the terrain; metres.
Box box_about(const io::Grid& grid, io::NodeId node, const TurningView& view) {
    const auto extent = static_cast<double>(grid.extent(node.level));
    const glm::dvec2 eye = glm::dvec2(view.eye.cell) + glm::dvec2(view.eye.cell_rest);
    const glm::dvec2 spacing_m(view.eye.spacing_m);
    const glm::dvec2 first = (extent * glm::dvec2(node.x, node.y) - eye) * spacing_m;
    const glm::dvec2 last = first + extent * spacing_m;
    return {{view.eye_m.x + first.x, view.eye_m.y - last.y, view.terrain_m.min.z},
            {view.eye_m.x + last.x, view.eye_m.y - first.y, view.terrain_m.max.z}};
}

}  // namespace

TileTurns::TileTurns(const io::Grid& grid, int slots)
    : grid_(grid), drawn_(static_cast<std::size_t>(slots)), turned_(static_cast<std::size_t>(slots)) {}

bool TileTurns::could_be_seen_before(io::NodeId node, std::uint32_t frame) const {
    if (!before_ || before_->frame + 1 != frame) return false;
    return contains(before_->view.visible, box_about(grid_, node, before_->view)) != Containment::outside;
}

float TileTurns::still_to_turn(const Drawn& drawn, const TurningMoment& moment) {
    if (!drawn.turning) return 0.0f;
    const pager::Seconds passed = moment.now - *drawn.turning;
    return passed < moment.fade ? static_cast<float>(std::min(1.0 - passed / moment.fade, 1.0)) : 0.0f;
}

std::span<const float> TileTurns::turn(std::span<const SlottedTile> tiles,
                                       std::span<const float> height_fades, const TurningMoment& moment,
                                       const TurningView& view) {
    if (last_ && last_->frame != moment.frame) before_ = last_;
    last_ = Seen{moment.frame, view};
    for (const SlottedTile& tile : tiles) {
        Drawn& drawn = drawn_[tile.slot];
        const bool goes_on = drawn.node == tile.node && drawn.last + 1 >= moment.frame;
        if (!goes_on) {
            drawn = {tile.node, 0, {}};
            if (could_be_seen_before(tile.node, moment.frame)) drawn.turning = moment.now;
        }
        drawn.last = moment.frame;
        turned_[tile.slot] = std::max(height_fades[tile.slot], still_to_turn(drawn, moment));
    }
    return turned_;
}

}  // namespace ridgeline::render
