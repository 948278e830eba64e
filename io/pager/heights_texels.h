// Heights as a texture holds them: one 32-bit integer a sample, apron included, north-western first.
//
// A texel is the height in sixteenths of a quantum, shifted left by one, plus 1 where the cell to its
// south-east is terrain (any source cell under it is valid): one fetch gives both, and integers keep what
// vertices share the same from every tile. Heights beyond 26 bits of quanta are no terrain's: the packing
// saturates. Levels above the finest hold some of the source's samples only; their texels are what three by
// three of these have on average (1 2 1 both ways), so that they are filtered to twice their spacing. Pure
// functions; any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "ridgeline/io/heights_tile.h"

namespace ridgeline::pager {

// Samples of a tile's side.
constexpr int heights_texels_side(int quads) { return quads + 1 + 2 * io::HeightsTile::kApron; }
constexpr std::size_t heights_texels_bytes(int quads) {
    const auto side = static_cast<std::size_t>(heights_texels_side(quads));
    return side * side * sizeof(std::int32_t);
}

// The texel at a place, row by row, of a tile in RAM, whose bytes need not be aligned; 0 past its end.
inline std::int32_t heights_texel(std::span<const std::byte> texels, std::size_t place) {
    std::int32_t texel = 0;
    if ((place + 1) * sizeof texel <= texels.size())
        std::memcpy(&texel, texels.data() + place * sizeof texel, sizeof texel);
    return texel;
}

enum class HeightsFilter { none, twice_spacing };

// texels: heights_texels_bytes(tile.quads). Cells of the apron count as terrain; its outermost samples repeat
// when they are filtered.
void pack_heights(const io::HeightsTile& tile, HeightsFilter filter, std::span<std::byte> texels);

}  // namespace ridgeline::pager
