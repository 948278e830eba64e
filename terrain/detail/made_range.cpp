// Noise reaches 2.8 times its deviation (four corners' gradients, all of them at their worst), and cubics go beyond the
// samples between which they run by 0.29 of the largest bend about them. In a rough place an octave may double the bend,
// and another one may double it again; that all of their noise conspires for it is as good as impossible, and what cannot
// be without it would be of no use to anybody: kilometres.
#include "ridgeline/detail/made_range.h"

#include <algorithm>

#include "ridgeline/shaders/lib/detail.h"

namespace ridgeline::detail {
namespace {

// Deviations of the next octave's noise that all octaves together may come to; and bends, of what is interpolated.
constexpr std::int64_t kGenerousBumps = 8, kGenerousBends = 1;

UnitRange widened(const UnitRange& samples, std::int64_t slope, std::int64_t roughness,
                  std::span<const io::DetailGains> gains) {
    std::int64_t bump = 0;
    for (const io::DetailGains& octave : gains)
        bump = std::max({bump, octave.face_slope * slope + octave.face_roughness * roughness,
                         octave.edge_slope * slope + octave.edge_roughness * roughness});
    const std::int64_t beside =
        kGenerousBumps * (bump / shaders::kDetailGainOne + 1) + kGenerousBends * roughness;
    return slope == 0 && roughness == 0 ? samples : UnitRange{samples.least - beside, samples.most + beside};
}

}  // namespace

UnitRange made_range(const DetailTile& parent, int quarter, std::span<const io::DetailGains> gains) {
    const int half = parent.quads / 2, west = (quarter & 1) * half, north = (quarter >> 1) * half;
    UnitRange samples{parent.height(west, north), parent.height(west, north)};
    std::int64_t slope = 0, roughness = 0;
    // What lies amid four is interpolated from one sample more on every side.
    for (int row = north - 1; row <= north + half + 1; ++row)
        for (int column = west - 1; column <= west + half + 1; ++column) {
            const glm::ivec2 at(column, row);
            const shaders::DetailControl control = shaders::detail_control(parent, at);
            slope = std::max<std::int64_t>(slope, control.slope);
            roughness = std::max<std::int64_t>(roughness, control.roughness);
            samples.least = std::min<std::int64_t>(samples.least, parent.height(at));
            samples.most = std::max<std::int64_t>(samples.most, parent.height(at));
        }
    return widened(samples, slope, roughness, gains);
}

UnitRange made_range(const UnitRange& samples, std::span<const io::DetailGains> gains) {
    const std::int64_t height = samples.most - samples.least;
    return widened(samples, height, 4 * height, gains);
}

}  // namespace ridgeline::detail
