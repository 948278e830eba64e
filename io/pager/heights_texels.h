// Heights as a texture holds them: one 32-bit integer a sample, apron included, north-western first.
//
// A texel is twice the height in quanta, plus 1 where the cell to its south-east is terrain (any source cell
// under it is valid): one fetch gives both, and integers keep what vertices share the same from every tile.
// Heights beyond 30 bits are no terrain's: the packing saturates. Pure functions; any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "ridgeline/io/heights_tile.h"

namespace ridgeline::pager {

// Samples of a tile's side.
constexpr int heights_texels_side(int quads) { return quads + 1 + 2 * io::HeightsTile::kApron; }
constexpr std::size_t heights_texels_bytes(int quads) {
    const auto side = static_cast<std::size_t>(heights_texels_side(quads));
    return side * side * sizeof(std::int32_t);
}

// texels: heights_texels_bytes(tile.quads), aligned for integers. Cells of the apron count as terrain.
void pack_heights(const io::HeightsTile& tile, std::span<std::byte> texels);

}  // namespace ridgeline::pager
