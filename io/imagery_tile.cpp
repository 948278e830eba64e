// Endpoints and indices go apart, the endpoints' bytes in planes with a frame and so a code table each: a
// byte of red and half of green, or of the other half and blue, says more together than fields that were told
// apart by differences (zion's Landsat: 0.28 bytes a pixel, and 0.33). Indices are packed 2×2 texels a byte.
#include "ridgeline/io/imagery_tile.h"

#include <cstring>

#include "ridgeline/io/zstd_stream.h"

namespace ridgeline::io {
namespace {

constexpr std::uint8_t kFormat = 1;
constexpr std::size_t kBlocks = kImageryBlockCount;
// Low and high bytes of the first endpoint, and of the second: a frame each.
constexpr std::size_t kEndpointPlanes = 4;
// North-western, north-eastern, south-western and south-eastern quarters: one frame.
constexpr std::size_t kIndexPlanes = 4;
// There are few repetitions to find: what shrinks is the code, at any level.
constexpr int kLevel = 1;

// From rows of four texels to quarters of 2×2, and back: the middle two groups of four bits in each half
// change places.
constexpr std::uint32_t exchanged(std::uint32_t indices) {
    return (indices & 0xf00ff00fu) | (indices & 0x00f000f0u) << 4 | (indices & 0x0f000f00u) >> 4;
}
static_assert(exchanged(0x000000f0u) == 0x00000f00u && exchanged(exchanged(0x12345678u)) == 0x12345678u);

}  // namespace

bool has_holes(const Bc1Block& block) {
    return block.first <= block.second && (block.indices & block.indices >> 1 & 0x55555555u) != 0;
}

void encode_imagery(std::span<const Bc1Block> blocks, ImageryScratch& scratch,
                    std::vector<std::uint8_t>& payload) {
    RIDGELINE_CHECK(blocks.size() == kBlocks);
    scratch.planes.resize((kEndpointPlanes + kIndexPlanes) * kBlocks);
    const auto plane = [&](std::size_t p) { return std::span(scratch.planes).subspan(p * kBlocks, kBlocks); };
    for (std::size_t i = 0; i < kBlocks; ++i) {
        const std::uint32_t endpoints = blocks[i].first | std::uint32_t{blocks[i].second} << 16;
        const std::uint32_t quarters = exchanged(blocks[i].indices);
        for (std::size_t byte = 0; byte < 4; ++byte) {
            plane(byte)[i] = static_cast<std::uint8_t>(endpoints >> (8 * byte));
            plane(kEndpointPlanes + byte)[i] = static_cast<std::uint8_t>(quarters >> (8 * byte));
        }
    }
    payload.push_back(kFormat);
    for (std::size_t p = 0; p < kEndpointPlanes; ++p) compress(plane(p), payload, kLevel);
    compress(std::span(scratch.planes).subspan(kEndpointPlanes * kBlocks), payload, kLevel);
}

Result<void> decode_imagery(std::span<const std::uint8_t> payload, ImageryScratch& scratch,
                            std::span<std::byte> block) {
    RIDGELINE_CHECK(block.size() == kImageryTileBytes);
    if (payload.empty() || payload[0] != kFormat) return Error{"damaged imagery tile"};
    payload = payload.subspan(1);
    scratch.planes.resize((kEndpointPlanes + kIndexPlanes) * kBlocks);
    const auto plane = [&](std::size_t p) { return std::span(scratch.planes).subspan(p * kBlocks, kBlocks); };
    for (std::size_t p = 0; p < kEndpointPlanes; ++p) RIDGELINE_TRY(decompress_front(payload, plane(p)));
    RIDGELINE_TRY(decompress(payload, std::span(scratch.planes).subspan(kEndpointPlanes * kBlocks)));
    for (std::size_t i = 0; i < kBlocks; ++i) {
        std::uint32_t endpoints = 0, quarters = 0;
        for (std::size_t byte = 0; byte < 4; ++byte) {
            endpoints |= std::uint32_t{plane(byte)[i]} << (8 * byte);
            quarters |= std::uint32_t{plane(kEndpointPlanes + byte)[i]} << (8 * byte);
        }
        const Bc1Block out{static_cast<std::uint16_t>(endpoints), static_cast<std::uint16_t>(endpoints >> 16),
                           exchanged(quarters)};
        std::memcpy(&block[i * sizeof out], &out, sizeof out);
    }
    return {};
}

}  // namespace ridgeline::io
