#include "ridgeline/render/disc_look.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "ridgeline/render/disc_grid.h"
#include "ridgeline/shaders/lib/disc.h"

namespace ridgeline::render {

std::int32_t DiscLook::texel(const glm::ivec2& at, std::uint32_t slot) const {
    return heights_.texel(at, slot, pager_);
}

double DiscLook::vertex_quanta(const glm::ivec2& cell, int ring) const {
    return static_cast<double>(shaders::disc_height(*this, heights_.uniforms(), cell, ring, eye_.quanta)) -
           static_cast<double>(eye_.quanta_rest);
}

double DiscLook::height_m(const glm::dvec2& place) const {
    const shaders::DiscUniforms& disc = heights_.uniforms();
    const glm::ivec2 eye_cell(disc.eye_cell_and_size);
    const int innermost = ring_range(static_cast<double>(disc.middle.z), 0.0).innermost;
    const DiscTriangle triangle = disc_triangle(shaders::kDiscRadius, eye_cell, innermost, place);
    double quanta = 0.0;
    for (std::size_t i = 0; i < 3; ++i)
        quanta += triangle.weights[i] * vertex_quanta(triangle.cells[i], triangle.ring);
    return quanta * static_cast<double>(eye_.quantum_m);
}

}  // namespace ridgeline::render
