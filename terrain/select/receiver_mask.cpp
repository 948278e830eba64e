// Literature: J. Bittner, O. Mattausch, A. Silvennoinen, M. Wimmer, "Shadow Caster Culling for Efficient
// Shadow Mapping" (I3D 2011), who draw what the camera sees into a mask in the light's view and test casters
// against it. The paper that this system follows (horizon paper, section 5) adds neighbours towards the sun
// by rule of thumb. Here the mask is boxes in a coarse grid on the CPU, so that it also decides what is
// paged, and it holds depths: a caster behind all receivers of a cell is none.
#include "ridgeline/select/receiver_mask.h"

#include <algorithm>
#include <limits>

namespace ridgeline::select {
namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();
// Rounding of depths to floats: 0.02 m at 200 km.
constexpr double kRounding_m = 0.05;
// Where receivers lie in a line, the grid still has an extent.
constexpr double kLeastExtent_m = 1e-3;

}  // namespace

void ReceiverMask::fill(std::span<const SunBox> receivers) {
    lowest_m_.fill(kNothing);
    origin_m_ = glm::dvec2(std::numeric_limits<double>::max());
    most_m_ = -origin_m_;
    for (const SunBox& box : receivers) {
        origin_m_ = glm::min(origin_m_, glm::dvec2(box.min));
        most_m_ = glm::max(most_m_, glm::dvec2(box.max));
    }
    if (receivers.empty()) return;
    cells_per_m_ = double{kSide} / glm::max(most_m_ - origin_m_, glm::dvec2(kLeastExtent_m));
    for (const SunBox& box : receivers) add(box);
}

ReceiverMask::Cells ReceiverMask::cells_under(const SunBox& box) const {
    const bool beside =
        box.max.x < origin_m_.x || box.max.y < origin_m_.y || box.min.x > most_m_.x || box.min.y > most_m_.y;
    if (beside) return {};
    const auto cell = [&](const glm::dvec3& corner) {
        const glm::dvec2 place = (glm::dvec2(corner) - origin_m_) * cells_per_m_;
        return glm::ivec2(glm::clamp(place, glm::dvec2(0.0), glm::dvec2(kSide - 1)));
    };
    return {cell(box.min), cell(box.max)};
}

void ReceiverMask::add(const SunBox& receiver) {
    const Cells cells = cells_under(receiver);
    const auto lowest_m = static_cast<float>(receiver.min.z - kRounding_m);
    for (int row = cells.first.y; row <= cells.last.y; ++row)
        for (int column = cells.first.x; column <= cells.last.x; ++column)
            lowest_m_[at(column, row)] = std::min(lowest_m_[at(column, row)], lowest_m);
}

bool ReceiverMask::shades(const SunBox& caster) const {
    const Cells cells = cells_under(caster);
    const auto highest_m = static_cast<float>(caster.max.z);
    for (int row = cells.first.y; row <= cells.last.y; ++row)
        for (int column = cells.first.x; column <= cells.last.x; ++column)
            if (lowest_m_[at(column, row)] <= highest_m) return true;
    return false;
}

}  // namespace ridgeline::select
