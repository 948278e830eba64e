#include <doctest/doctest.h>

#include <random>

#include "ridgeline/io/heights_tile.h"

using namespace ridgeline;
using namespace ridgeline::io;

namespace {

HeightsTile random_tile(std::mt19937& random, int quads, std::uint32_t range, bool holes) {
    HeightsTile tile;
    tile.quads = quads;
    tile.all_valid = !holes;
    const auto count = static_cast<std::size_t>(tile.stride() * tile.stride());
    for (std::size_t i = 0; i < count; ++i)
        tile.quanta.push_back(range == 0 ? static_cast<std::int32_t>(random())
                                         : static_cast<std::int32_t>(random() % range) -
                                               static_cast<std::int32_t>(range / 2));
    if (!holes) return tile;
    for (std::size_t i = 0; i < count; ++i) tile.sample_valid.push_back(random() % 3 != 0);
    for (int i = 0; i < quads * quads; ++i) tile.cell_valid.push_back(random() % 2);
    return tile;
}

}  // namespace

TEST_CASE("heights: any tile survives the codec, down to the last bit") {
    std::mt19937 random(7);
    for (const std::uint32_t range : {1u, 10u, 4000u, 1u << 20, 0u})
        for (const bool holes : {false, true})
            for (const int quads : {32, 64, 128}) {
                const HeightsTile tile = random_tile(random, quads, range, holes);
                std::vector<std::uint8_t> payload = {1, 2, 3};  // appended to what is there
                encode_heights(tile, payload);
                HeightsTile back;
                REQUIRE(decode_heights(std::span(payload).subspan(3), quads, back));
                CHECK(back.quanta == tile.quanta);
                CHECK(back.all_valid == tile.all_valid);
                CHECK(back.sample_valid == tile.sample_valid);
                CHECK(back.cell_valid == tile.cell_valid);
            }
}

TEST_CASE("heights: a smooth whole-metre tile takes well under a byte a sample") {
    HeightsTile tile;
    for (int row = 0; row < tile.stride(); ++row)
        for (int column = 0; column < tile.stride(); ++column)
            tile.quanta.push_back((row * row + 3 * column * row) / 50);
    std::vector<std::uint8_t> payload;
    encode_heights(tile, payload);
    CHECK(payload.size() < tile.quanta.size() / 2);
}

TEST_CASE("heights: every cut and every flipped bit is an error or another tile, never a crash") {
    std::mt19937 random(3);
    std::vector<std::uint8_t> payload;
    encode_heights(random_tile(random, 32, 100, true), payload);
    HeightsTile tile;
    for (std::size_t size = 0; size < payload.size(); ++size)
        CHECK_FALSE(decode_heights(std::span(payload).first(size), 32, tile).ok());
    for (std::size_t bit = 0; bit < payload.size() * 8; ++bit) {
        auto damaged = payload;
        damaged[bit / 8] = static_cast<std::uint8_t>(damaged[bit / 8] ^ (1u << (bit % 8)));
        (void)decode_heights(damaged, 32, tile).ok();
    }
}
