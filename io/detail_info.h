// What terrain.json says of ground finer than the source: how high its bumps are, octave by octave, as the source's own
// finest octaves foretell (docs/detail.md).
#pragma once

#include <array>
#include <vector>

namespace ridgeline::io {

// In 1/4096: what a metre of slope over a spacing, and a metre of bend, are worth in metres of displacement; of samples
// in the middle of four, and between two (shaders/shared/detail_octave.h).
struct DetailGains {
    int face_slope = 0, face_roughness = 0, edge_slope = 0, edge_roughness = 0;

    friend bool operator==(const DetailGains&, const DetailGains&) = default;
};

struct DetailInfo {
    // Octaves that a store can tell of: a spacing of 20 m becomes 8 cm.
    static constexpr int kMostOctaves = 8;
    static constexpr int kMostGain = 8191;

    // How far the source's samples lie beside what is interpolated from every second of them, root mean square, metres:
    // at the source's spacing, at twice and at four times that; in the middle of four, and between two.
    std::array<double, 3> face_residual_m{}, edge_residual_m{};
    // At half the spacing, at a quarter of it, ...
    std::vector<DetailGains> octaves;

    friend bool operator==(const DetailInfo&, const DetailInfo&) = default;
};

}  // namespace ridgeline::io
