// The imagery tile's codec: what goes in comes out, and nothing else is taken for a tile.
#include <doctest/doctest.h>

#include <random>

#include "ridgeline/io/imagery_tile.h"

using namespace ridgeline::io;

namespace {

std::vector<Bc1Block> random_blocks(std::uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<Bc1Block> blocks(kImageryBlockCount);
    for (Bc1Block& block : blocks)
        block = {static_cast<std::uint16_t>(random()), static_cast<std::uint16_t>(random()),
                 static_cast<std::uint32_t>(random())};
    return blocks;
}

std::vector<Bc1Block> decoded(std::span<const std::uint8_t> payload) {
    std::vector<Bc1Block> blocks(kImageryBlockCount);
    ImageryScratch scratch;
    REQUIRE(decode_imagery(payload, scratch, std::as_writable_bytes(std::span(blocks))));
    return blocks;
}

// Any blocks, but few kinds of them, as pictures have.
std::vector<Bc1Block> plain_blocks() {
    std::vector<Bc1Block> blocks(kImageryBlockCount);
    for (std::size_t i = 0; i < blocks.size(); ++i)
        blocks[i] = {static_cast<std::uint16_t>(40000 + i / 900), 20000, 0x1b1b1b1bu};
    return blocks;
}

}  // namespace

TEST_CASE("imagery tile: any blocks come back as they were") {
    ImageryScratch scratch;
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
        const auto blocks = random_blocks(seed);
        std::vector<std::uint8_t> payload;
        encode_imagery(blocks, scratch, payload);
        CHECK(decoded(payload) == blocks);
    }
}

TEST_CASE("imagery tile: cut at any length it is refused") {
    std::vector<std::uint8_t> payload;
    ImageryScratch scratch;
    encode_imagery(plain_blocks(), scratch, payload);
    std::vector<std::byte> block(kImageryTileBytes);
    for (std::size_t size = 0; size < payload.size(); ++size)
        CHECK_FALSE(decode_imagery(std::span(payload).first(size), scratch, block).ok());
    payload.push_back(0);
    CHECK_FALSE(decode_imagery(payload, scratch, block).ok());
}

TEST_CASE("imagery tile: flipped bits never reach past the tile") {
    std::vector<std::uint8_t> payload;
    ImageryScratch scratch;
    encode_imagery(plain_blocks(), scratch, payload);
    std::vector<std::byte> block(kImageryTileBytes);
    for (std::size_t bit = 0; bit < payload.size() * 8; ++bit) {
        auto damaged = payload;
        damaged[bit / 8] = static_cast<std::uint8_t>(damaged[bit / 8] ^ (1u << (bit % 8)));
        // Whether a flip shows is the checksum's business; what must hold is that it does no harm.
        static_cast<void>(decode_imagery(damaged, scratch, block));
    }
}

TEST_CASE("imagery tile: a block has holes where three colours leave an index, and it is used") {
    CHECK(has_holes({1, 2, 0x3u}));
    CHECK(has_holes({2, 2, 0xc0000000u}));
    CHECK_FALSE(has_holes({2, 1, 0xffffffffu}));
    CHECK_FALSE(has_holes({1, 2, 0x66666666u}));
    CHECK_FALSE(has_holes({1, 2, 0x99999999u}));
}
