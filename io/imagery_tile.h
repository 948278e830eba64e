// An imagery tile: BC1 blocks of one node's texels with a gutter, and of the next coarser mip of them, ready
// for a texture; packed for the disk.
//
// Mip 0 is (256 + 2·4)² texels: the node's own and four more on every side, which are the neighbours' (or,
// beyond the lattice, the nearest of the lattice); mip 1 is its 2×2 means, 132² texels with a gutter of two.
// Colours are sRGB-coded, means are taken in linear light. A texel without imagery is BC1's transparent one:
// index 3 of a block whose first endpoint is not above its second. Blocks are in rows, the north-western
// first, mip 0 before mip 1. Blocks of mip 0 are the same in every tile that shows their texels.
//
// Thread rules: pure functions; one ImageryScratch a thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ridgeline/base/result.h"
#include "ridgeline/io/imagery_info.h"

namespace ridgeline::io {

// Texels beyond the content on every side: two for bilinear filtering of mip 1, and whole blocks.
constexpr int kImageryGutter = 4;
constexpr int kImageryTexels = kImageryTile + 2 * kImageryGutter;  // mip 0's side
constexpr int kImageryMipTexels = kImageryTexels / 2;              // mip 1's side
constexpr int kImageryBlocks = kImageryTexels / 4;                 // mip 0's side in blocks
constexpr int kImageryMipBlocks = kImageryMipTexels / 4;           // mip 1's side in blocks
constexpr int kImageryBlockCount = kImageryBlocks * kImageryBlocks + kImageryMipBlocks * kImageryMipBlocks;

// Two endpoints of 5, 6 and 5 bits, sixteen indices of two bits; little-endian.
struct Bc1Block {
    std::uint16_t first = 0;
    std::uint16_t second = 0;
    std::uint32_t indices = 0;  // the north-western texel's lowest, row by row

    friend constexpr bool operator==(const Bc1Block&, const Bc1Block&) = default;
};
static_assert(sizeof(Bc1Block) == 8);

constexpr std::size_t kImageryTileBytes = std::size_t{kImageryBlockCount} * sizeof(Bc1Block);
static_assert(kImageryTileBytes == 43560);
// Where mip 1 begins.
constexpr std::size_t kImageryMipOffset =
    std::size_t{kImageryBlocks} * std::size_t{kImageryBlocks} * sizeof(Bc1Block);

// Whether some texel of the block is transparent.
bool has_holes(const Bc1Block& block);

// Working memory of the codec.
struct ImageryScratch {
    std::vector<std::uint8_t> planes;
};

// Appends the packed tile to `payload`; `blocks` are kImageryBlockCount.
void encode_imagery(std::span<const Bc1Block> blocks, ImageryScratch& scratch,
                    std::vector<std::uint8_t>& payload);
// Unpacks into kImageryTileBytes at `block`. Fails on any damaged payload, never reads past it.
Result<void> decode_imagery(std::span<const std::uint8_t> payload, ImageryScratch& scratch,
                            std::span<std::byte> block);

}  // namespace ridgeline::io
