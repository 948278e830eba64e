// What is seen of the terrain, as coarsely as it takes little time, from where the sun is: per cell of a grid
// across its rays, how far down they must come to reach everything seen there. A caster that no such cell has
// below it cannot darken anything that is seen.
//
// Conservative both ways: a receiver fills every cell that it touches, a caster asks all that it touches.
// Internal to the room; fixed memory.
#pragma once

#include <array>
#include <cstddef>
#include <glm/glm.hpp>
#include <span>

#include "ridgeline/select/sun_view.h"

namespace ridgeline::select {

class ReceiverMask {
  public:
    // Forgets what was there before.
    void fill(std::span<const SunBox> receivers);
    // Whether a box touches or lies before a receiver, towards the sun.
    bool shades(const SunBox& caster) const;

  private:
    // Cells a side. More find few casters fewer: leaves far away are larger than a cell, and near ones lie in
    // the cells of their own shadows.
    static constexpr int kSide = 128;

    struct Cells {
        glm::ivec2 first{0}, last{-1};
    };
    Cells cells_under(const SunBox& box) const;
    void add(const SunBox& receiver);
    static std::size_t at(int column, int row) {
        return static_cast<std::size_t>(row) * kSide + static_cast<std::size_t>(column);
    }

    glm::dvec2 origin_m_{0.0};
    glm::dvec2 most_m_{0.0};
    glm::dvec2 cells_per_m_{0.0};
    std::array<float, std::size_t{kSide} * kSide> lowest_m_{};
};

}  // namespace ridgeline::select
