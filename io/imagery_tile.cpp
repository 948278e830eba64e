// Endpoints and indices go apart, byte by byte in planes: neighbours' endpoints are alike, so each is the
// difference to the block before, field by field (modulo the field's size); indices are left as they are.
#include "ridgeline/io/imagery_tile.h"

#include <cstring>

#include "ridgeline/io/zstd_stream.h"

namespace ridgeline::io {
namespace {

constexpr std::uint8_t kFormat = 1;
constexpr std::size_t kBlocks = kImageryBlockCount;
// first: blue, green, red; second likewise; four rows of indices
constexpr std::size_t kPlanes = 10;

struct Fields {
    std::uint32_t red = 0, green = 0, blue = 0;
};
constexpr Fields fields_of(std::uint32_t colour) {
    return {colour >> 11 & 31u, colour >> 5 & 63u, colour & 31u};
}
constexpr std::uint32_t colour_of(Fields f) {
    return (f.red & 31u) << 11 | (f.green & 63u) << 5 | (f.blue & 31u);
}

class Planes {
  public:
    explicit Planes(std::uint8_t* bytes) : bytes_(bytes) {}
    std::uint8_t& at(std::size_t plane, std::size_t block) { return bytes_[plane * kBlocks + block]; }

  private:
    std::uint8_t* bytes_;
};

void put_colour(Planes& planes, std::size_t plane, std::size_t block, Fields colour, Fields before) {
    planes.at(plane, block) = static_cast<std::uint8_t>((colour.blue - before.blue) & 31u);
    planes.at(plane + 1, block) = static_cast<std::uint8_t>((colour.green - before.green) & 63u);
    planes.at(plane + 2, block) = static_cast<std::uint8_t>((colour.red - before.red) & 31u);
}

Fields take_colour(Planes& planes, std::size_t plane, std::size_t block, Fields before) {
    return {(before.red + planes.at(plane + 2, block)) & 31u,
            (before.green + planes.at(plane + 1, block)) & 63u,
            (before.blue + planes.at(plane, block)) & 31u};
}

}  // namespace

bool has_holes(const Bc1Block& block) {
    return block.first <= block.second && (block.indices & block.indices >> 1 & 0x55555555u) != 0;
}

void encode_imagery(std::span<const Bc1Block> blocks, ImageryScratch& scratch,
                    std::vector<std::uint8_t>& payload) {
    RIDGELINE_CHECK(blocks.size() == kBlocks);
    scratch.planes.resize(kPlanes * kBlocks);
    Planes planes(scratch.planes.data());
    Fields before;
    for (std::size_t i = 0; i < kBlocks; ++i) {
        const Fields first = fields_of(blocks[i].first), second = fields_of(blocks[i].second);
        put_colour(planes, 0, i, first, before);
        put_colour(planes, 3, i, second, first);
        before = first;
        for (std::size_t row = 0; row < 4; ++row)
            planes.at(6 + row, i) = static_cast<std::uint8_t>(blocks[i].indices >> (8 * row));
    }
    payload.push_back(kFormat);
    compress(scratch.planes, payload);
}

Result<void> decode_imagery(std::span<const std::uint8_t> payload, ImageryScratch& scratch,
                            std::span<std::byte> block) {
    RIDGELINE_CHECK(block.size() == kImageryTileBytes);
    if (payload.empty() || payload[0] != kFormat) return Error{"damaged imagery tile"};
    scratch.planes.resize(kPlanes * kBlocks);
    RIDGELINE_TRY(decompress(payload.subspan(1), scratch.planes));
    Planes planes(scratch.planes.data());
    Fields before;
    for (std::size_t i = 0; i < kBlocks; ++i) {
        const Fields first = take_colour(planes, 0, i, before);
        const Fields second = take_colour(planes, 3, i, first);
        before = first;
        Bc1Block out;
        out.first = static_cast<std::uint16_t>(colour_of(first));
        out.second = static_cast<std::uint16_t>(colour_of(second));
        for (std::size_t row = 0; row < 4; ++row)
            out.indices |= std::uint32_t{planes.at(6 + row, i)} << (8 * row);
        std::memcpy(&block[i * sizeof out], &out, sizeof out);
    }
    return {};
}

}  // namespace ridgeline::io
