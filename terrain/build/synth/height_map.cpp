#include "height_map.h"

#include <algorithm>

namespace ridgeline::synth {

std::array<float, 4> spline_weights(float t) {
    const float s = 1.0f - t;
    return {s * s * s / 6, (3 * t * t * t - 6 * t * t + 4) / 6, (3 * s * s * s - 6 * s * s + 4) / 6,
            t * t * t / 6};
}

std::array<float, 4> spline_slopes(float t) {
    const float s = 1.0f - t;
    return {-s * s / 2, (3 * t * t - 4 * t) / 2, (4 * s - 3 * s * s) / 2, t * t / 2};
}

float HeightMap::smooth_at(float column, float row) const {
    const float last = static_cast<float>(nodes - 3);
    column = std::clamp(column, 1.0f, last);
    row = std::clamp(row, 1.0f, last);
    const int i = std::min(static_cast<int>(column), nodes - 3);
    const int j = std::min(static_cast<int>(row), nodes - 3);
    const auto across = spline_weights(column - static_cast<float>(i));
    const auto down = spline_weights(row - static_cast<float>(j));
    float sum = 0.0f;
    for (int b = 0; b < 4; ++b)
        for (int a = 0; a < 4; ++a)
            sum += across[static_cast<std::size_t>(a)] * down[static_cast<std::size_t>(b)] *
                   at(i + a - 1, j + b - 1);
    return sum;
}

}  // namespace ridgeline::synth
