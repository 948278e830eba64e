// A square grid of heights, read as a smooth surface.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace ridgeline::synth {

struct HeightMap {
    int nodes = 0;  // along either side
    float cell_m = 1.0f;
    std::vector<float> heights_m;

    float at(int column, int row) const {
        return heights_m[static_cast<std::size_t>(row) * static_cast<std::size_t>(nodes) +
                         static_cast<std::size_t>(column)];
    }
    // The uniform cubic B-spline over the nodes, at a position in cells; the rim is held.
    float smooth_at(float column, float row) const;
};

// The spline's four weights at t in [0, 1) between nodes 1 and 2, and their derivatives.
std::array<float, 4> spline_weights(float t);
std::array<float, 4> spline_slopes(float t);

}  // namespace ridgeline::synth
