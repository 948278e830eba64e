#include "ridgeline/detail/finer_ground.h"

#include <algorithm>
#include <cmath>

#include "ridgeline/base/contract.h"
#include "ridgeline/detail/detail_tile.h"

namespace ridgeline::detail {
namespace {

constexpr std::int64_t kMostNodes = 65535;
// Slopes ten times the usual ones, under noise of nearly three times its deviation, all octaves together twice the first.
constexpr double kGenerous = 64.0;

int scaled(int gain, double roughness) {
    return static_cast<int>(std::clamp(std::lround(gain * roughness), 0L, long{io::DetailInfo::kMostGain}));
}

}  // namespace

int most_octaves(const io::TerrainInfo& info) {
    if (!info.detail) return 0;
    const io::Grid grid = info.grid();
    const std::int64_t nodes = std::max(grid.nodes_x(grid.finest()), grid.nodes_y(grid.finest()));
    int octaves = 0;
    while (octaves < static_cast<int>(info.detail->octaves.size()) &&
           grid.levels() + octaves < io::Grid::kMaxLevels && nodes << (octaves + 1) <= kMostNodes)
        ++octaves;
    return octaves;
}

FinerGround finer_ground(const io::TerrainInfo& info, int octaves, double roughness) {
    RIDGELINE_CHECK(octaves >= 0 && octaves <= most_octaves(info));
    FinerGround ground{.shift = detail_shift(info), .gains = {}};
    for (int i = 0; i < octaves; ++i) {
        const io::DetailGains& gains = info.detail->octaves[static_cast<std::size_t>(i)];
        ground.gains.push_back({scaled(gains.face_slope, roughness), scaled(gains.face_roughness, roughness),
                                scaled(gains.edge_slope, roughness),
                                scaled(gains.edge_roughness, roughness)});
    }
    return ground;
}

io::TerrainInfo finer_lattice(const io::TerrainInfo& info, int octaves) {
    const io::Grid grid = info.grid().finer(octaves);
    io::TerrainInfo finer = info;
    finer.width = grid.width();
    finer.height = grid.height();
    finer.spacing_x_m = std::ldexp(info.spacing_x_m, -octaves);
    finer.spacing_y_m = std::ldexp(info.spacing_y_m, -octaves);
    finer.made_octaves = info.made_octaves + octaves;
    return finer;
}

double generous_displacement_m(const io::TerrainInfo& info, const FinerGround& ground) {
    if (ground.gains.empty() || !info.detail) return 0.0;
    int most = 0;
    for (const io::DetailGains& gains : ground.gains)
        most =
            std::max({most, gains.face_slope, gains.face_roughness, gains.edge_slope, gains.edge_roughness});
    return most == 0 ? 0.0 : kGenerous * (info.detail->face_residual_m[0] + info.quantum_m);
}

}  // namespace ridgeline::detail
