#include "ridgeline/detail/detail_tile.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "ridgeline/base/contract.h"
#include "ridgeline/shaders/lib/detail.h"

namespace ridgeline::detail {
namespace {

constexpr int kApron = io::HeightsTile::kApron;
constexpr int kMostShift = 16;
// Differences of heights, times nine, stay within 32 bits; and bumps may reach beyond the source's own range.
constexpr int kHeightBits = 26;
// Of a spacing: slopes of 8 are still told apart (shaders/lib/detail.h, kMostDetailControl), and at the eighth octave there
// are 128 steps to a spacing.
constexpr double kStepsPerSpacing = 32768.0;

}  // namespace

int detail_shift(const io::TerrainInfo& info) {
    const double lowest = std::abs(info.min_height_m - info.height_offset_m) / info.quantum_m;
    const double highest = std::abs(info.max_height_m - info.height_offset_m) / info.quantum_m;
    const auto most = static_cast<std::uint64_t>(std::max(lowest, highest)) + 1;
    const int for_range = kHeightBits - static_cast<int>(std::bit_width(most));
    const double steps = kStepsPerSpacing * info.quantum_m / std::min(info.spacing_x_m, info.spacing_y_m);
    return std::clamp(std::min(for_range, static_cast<int>(std::floor(std::log2(steps)))), 0, kMostShift);
}

void make_root(const io::HeightsTile& source, io::NodeId node, int shift, DetailTile& tile) {
    tile.quads = source.quads;
    tile.node = node;
    tile.octave = 0;
    tile.heights.resize(source.quanta.size());
    std::ranges::transform(source.quanta, tile.heights.begin(),
                           [shift](std::int32_t quanta) { return quanta * (1 << shift); });
}

void make_child(const DetailTile& parent, int quarter, const io::DetailGains& gains, DetailTile& tile) {
    RIDGELINE_CHECK(&parent != &tile);
    const int quads = parent.quads;
    tile.quads = quads;
    tile.node = parent.node.child(quarter);
    tile.octave = parent.octave + 1;
    tile.heights.resize(parent.heights.size());
    const glm::ivec2 corner((quarter & 1) * quads, (quarter >> 1) * quads);
    const glm::ivec2 first(parent.node.x * quads, parent.node.y * quads);
    const shaders::DetailOctave octave{gains.face_slope, gains.face_roughness, gains.edge_slope,
                                       gains.edge_roughness};
    auto to = tile.heights.begin();
    for (int row = -kApron; row <= quads + kApron; ++row)
        for (int column = -kApron; column <= quads + kApron; ++column)
            *to++ =
                shaders::detail_sample(parent, corner + glm::ivec2(column, row), first, tile.octave, octave);
}

}  // namespace ridgeline::detail
