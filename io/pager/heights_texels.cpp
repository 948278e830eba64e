#include "ridgeline/pager/heights_texels.h"

#include <algorithm>
#include <cstring>

#include "ridgeline/base/contract.h"

namespace ridgeline::pager {
namespace {

constexpr std::int32_t kMost = (1 << 30) - 1;

// Row by row; only the tile's own cells may be no terrain.
std::int32_t valid_bit(const io::HeightsTile& tile, int column, int row) {
    if (tile.all_valid || column < 0 || row < 0 || column >= tile.quads || row >= tile.quads) return 1;
    return tile.cell_valid[static_cast<std::size_t>(row * tile.quads + column)];
}

}  // namespace

void pack_heights(const io::HeightsTile& tile, std::span<std::byte> texels) {
    RIDGELINE_CHECK(texels.size() == heights_texels_bytes(tile.quads));
    constexpr int kApron = io::HeightsTile::kApron;
    std::byte* to = texels.data();
    for (int row = -kApron; row <= tile.quads + kApron; ++row)
        for (int column = -kApron; column <= tile.quads + kApron; ++column) {
            const std::int32_t quanta = std::clamp(tile.quanta[tile.at(column, row)], -kMost, kMost);
            const std::int32_t texel = 2 * quanta + valid_bit(tile, column, row);
            std::memcpy(to, &texel, sizeof texel);
            to += sizeof texel;
        }
}

}  // namespace ridgeline::pager
