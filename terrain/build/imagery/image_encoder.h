// What turns texels into BC1 blocks: the CPU's encoder stands behind this, and a GPU's may.
//
// Whoever makes tiles does not wait for their blocks: encode() takes squares of texels and calls back when their
// blocks are there. The CPU's does so before it returns; a GPU's goes through the thread that owns the context.
// Thread rules: encode() from any thread, several at once.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "ridgeline/base/result.h"
#include "ridgeline/build/imagery/texel_rows.h"
#include "ridgeline/io/imagery_tile.h"

namespace ridgeline::build {

// side² texels, rows from the north, and the (side / 4)² blocks that are to be made of them; side is a multiple of
// 4. Texels of alpha 0 become transparent, all others opaque.
struct TexelSquare {
    std::span<const Texel> texels;
    int side = 0;
    std::span<io::Bc1Block> blocks;
};

// Row by row.
using BlockTexels = std::array<Texel, 16>;
// Calls visit(texels, block) for each of the square's blocks.
template <class Visit>
void for_each_block(const TexelSquare& square, Visit visit) {
    const auto stride = static_cast<std::size_t>(square.side), across = stride / 4;
    RIDGELINE_CHECK(square.side % 4 == 0 && square.texels.size() == stride * stride &&
                    square.blocks.size() == across * across);
    BlockTexels texels;
    for (std::size_t i = 0; i < square.blocks.size(); ++i) {
        const std::size_t corner = i / across * 4 * stride + i % across * 4;
        for (std::size_t row = 0; row < 4; ++row)
            for (std::size_t column = 0; column < 4; ++column)
                texels[row * 4 + column] = square.texels[corner + row * stride + column];
        visit(texels, square.blocks[i]);
    }
}

class ImageEncoder {
  public:
    virtual ~ImageEncoder() = default;

    // Called once, on whatever thread, with the blocks in place or why they are not. Must not wait.
    using Done = std::function<void(const Result<void>& encoded)>;
    // Texels and blocks must stay until then; `squares` need not. The same texels give the same block wherever they
    // lie. No more than tiles_under_way() calls at once, none of them of more texels than a tile's with its mip.
    virtual void encode(std::span<const TexelSquare> squares, Done done) = 0;

    // How many tiles to keep under way where so many threads make their texels.
    virtual int tiles_under_way(int threads) const = 0;
    // What it takes of memory, beside the tiles.
    virtual std::uint64_t memory_bytes() const = 0;
};

// On the CPU, by stb_dxt in its high-quality mode.
std::unique_ptr<ImageEncoder> make_cpu_encoder();
// A single block as that encoder makes it.
io::Bc1Block encode_on_cpu(const BlockTexels& texels);

}  // namespace ridgeline::build
