// A decoded tile of imagery, texel by texel.
#pragma once

#include <span>

#include "ridgeline/build/imagery/block_texels.h"
#include "ridgeline/io/imagery_tile.h"

namespace ridgeline::test {

using build::texel_of_block;

// A colour of a decoded tile's mip 0, column and row from the content's corner, −4 to 259.
inline build::Texel texel_of(std::span<const io::Bc1Block> blocks, int column, int row) {
    const int x = column + io::kImageryGutter, y = row + io::kImageryGutter;
    return texel_of_block(blocks[static_cast<std::size_t>(y / 4 * io::kImageryBlocks + x / 4)],
                          y % 4 * 4 + x % 4);
}

}  // namespace ridgeline::test
