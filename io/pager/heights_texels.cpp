#include "ridgeline/pager/heights_texels.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "ridgeline/base/contract.h"

namespace ridgeline::pager {
namespace {

constexpr std::int32_t kMost = (1 << 26) - 1;
constexpr int kApron = io::HeightsTile::kApron;

std::int32_t sample(const io::HeightsTile& tile, int column, int row) {
    const int last = tile.quads + kApron;
    const std::size_t at = tile.at(std::clamp(column, -kApron, last), std::clamp(row, -kApron, last));
    return std::clamp(tile.quanta[at], -kMost, kMost);
}

std::int32_t filtered_sixteenths(const io::HeightsTile& tile, int column, int row) {
    std::int32_t sum = 0;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x)
            sum += (2 - std::abs(x)) * (2 - std::abs(y)) * sample(tile, column + x, row + y);
    return sum;
}

// Row by row; only the tile's own cells may be no terrain.
std::int32_t valid_bit(const io::HeightsTile& tile, int column, int row) {
    if (tile.all_valid || column < 0 || row < 0 || column >= tile.quads || row >= tile.quads) return 1;
    return tile.cell_valid[static_cast<std::size_t>(row * tile.quads + column)];
}

}  // namespace

void pack_heights(const io::HeightsTile& tile, HeightsFilter filter, std::span<std::byte> texels) {
    RIDGELINE_CHECK(texels.size() == heights_texels_bytes(tile.quads));
    std::byte* to = texels.data();
    for (int row = -kApron; row <= tile.quads + kApron; ++row)
        for (int column = -kApron; column <= tile.quads + kApron; ++column) {
            const std::int32_t sixteenths = filter == HeightsFilter::none
                                                ? 16 * sample(tile, column, row)
                                                : filtered_sixteenths(tile, column, row);
            const std::int32_t texel = 2 * sixteenths + valid_bit(tile, column, row);
            std::memcpy(to, &texel, sizeof texel);
            to += sizeof texel;
        }
}

}  // namespace ridgeline::pager
