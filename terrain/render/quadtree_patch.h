// The triangles of a drawn cell, the same for every one: a square of quads, which are divided as the disc's
// are (shaders/lib/disc.h, coarse_diagonal). Pure arithmetic; any thread.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace ridgeline::render {

// Three indices a triangle, anticlockwise from above; vertices count row by row, quads + 1 in each.
inline std::vector<std::uint16_t> quadtree_patch(int quads) {
    std::vector<std::uint16_t> indices;
    for (int row = 0; row < quads; ++row)
        for (int column = 0; column < quads; ++column) {
            const int nw = row * (quads + 1) + column, ne = nw + 1, sw = nw + quads + 1, se = sw + 1;
            const bool from_north_west = ((column ^ row) & 1) == 0;
            for (const int i :
                 from_north_west ? std::array{nw, sw, se, nw, se, ne} : std::array{nw, sw, ne, ne, sw, se})
                indices.push_back(static_cast<std::uint16_t>(i));
        }
    return indices;
}

}  // namespace ridgeline::render
