#include "ridgeline/build/detail_windows.h"

#include <algorithm>

#include "ridgeline/detail/calibration.h"
#include "ridgeline/detail/detail_tile.h"
#include "ridgeline/io/heights_tile.h"

namespace ridgeline::build {
namespace {

// About so many; real mountains' residuals are then known to a few per cent.
constexpr std::uint64_t kWindows = 400;

}  // namespace

DetailWindows::DetailWindows(const io::Grid& grid) : grid_(grid) {
    const auto finest = static_cast<std::uint64_t>(grid.first(grid.finest() + 1) - grid.first(grid.finest()));
    one_in_ = std::max<std::uint64_t>(1, finest / kWindows);
}

// By a hash: a regular pattern could follow the land's own.
bool DetailWindows::is_wanted(io::NodeId node) const {
    return node.level == grid_.finest() && io::NodeIdHash{}(node) % one_in_ == 0;
}

void DetailWindows::offer(io::NodeId node, std::span<const std::uint8_t> payload) {
    if (is_wanted(node))
        tiles_.emplace_back(grid_.linear(node), std::vector<std::uint8_t>(payload.begin(), payload.end()));
}

Result<io::DetailInfo> DetailWindows::calibrate(const io::TerrainInfo& info) {
    std::ranges::sort(tiles_);
    const int shift = detail::detail_shift(info);
    std::vector<detail::DetailTile> windows;
    io::HeightsTile tile;
    for (const auto& [place, payload] : tiles_) {
        RIDGELINE_TRY(io::decode_heights(payload, grid_.quads(), tile));
        if (!tile.all_valid) continue;
        detail::make_root(tile, grid_.node_at(place), shift, windows.emplace_back());
    }
    return detail::calibrate(windows, {info.quantum_m / static_cast<double>(1 << shift), info.quantum_m});
}

}  // namespace ridgeline::build
