// BC1 blocks as the hardware shows them, texel by texel.
#pragma once

#include <array>
#include <cstdint>

#include "ridgeline/build/imagery/texel_rows.h"
#include "ridgeline/io/imagery_tile.h"

namespace ridgeline::build {

// Khronos Data Format Specification, 18.1 and 18.2. `texel` counts row by row.
inline Texel texel_of_block(const io::Bc1Block& block, int texel) {
    const auto widen = [](std::uint16_t c) {
        const int r = c >> 11, g = c >> 5 & 63, b = c & 31;
        return std::array{r << 3 | r >> 2, g << 2 | g >> 4, b << 3 | b >> 2};
    };
    const auto first = widen(block.first), second = widen(block.second);
    const std::uint32_t index = block.indices >> (2 * texel) & 3u;
    const bool three = block.first <= block.second;
    if (three && index == 3) return {};
    const auto mixed = [&](std::size_t i) {
        const int a = first[i], b = second[i];
        if (index < 2) return static_cast<std::uint8_t>(index == 0 ? a : b);
        if (three) return static_cast<std::uint8_t>((a + b) / 2);
        return static_cast<std::uint8_t>(index == 2 ? (2 * a + b) / 3 : (a + 2 * b) / 3);
    };
    return {mixed(0), mixed(1), mixed(2), kOpaque};
}

}  // namespace ridgeline::build
