// Where cells meet chunks: vertices on a border stand where the chunk beyond has some, whichever cell they belong to.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

#include "ridgeline/shaders/lib/quadtree_seam.h"

using namespace ridgeline;

namespace {

// A block's words, of a border of so many samples: which of them a chunk has.
struct Seams {
    std::vector<std::uint32_t> words = std::vector<std::uint32_t>(3 * 4 * shaders::kSeamWords, 0);

    std::uint32_t word(int i) const { return words[static_cast<std::size_t>(i)]; }
    void set(int block, int side, int at) {
        words[static_cast<std::size_t>((4 * block + side) * shaders::kSeamWords + at / 32)] |= 1u << at % 32;
    }
};

constexpr int kSides = 4;

}  // namespace

TEST_CASE("The place on a seam is the last at or before one that the chunk has: random borders") {
    std::mt19937 random(20261128);
    for (int round = 0; round < 200; ++round) {
        const int samples = std::array{32, 64, 128, 256}[random() % 4];
        const unsigned sparse = 1 + random() % 40;
        Seams seams;
        std::array<std::vector<int>, kSides> kept;
        for (int side = 0; side < kSides; ++side)
            for (int at = 0; at < samples; ++at)
                if (at == 0 || random() % sparse == 0) {
                    seams.set(1, side, at);
                    kept[static_cast<std::size_t>(side)].push_back(at);
                }
        int wrong = 0;
        for (int side = 0; side < kSides; ++side)
            for (int at = 0; at < samples; ++at) {
                const auto& places = kept[static_cast<std::size_t>(side)];
                const int expected = *std::prev(std::ranges::upper_bound(places, at));
                wrong += shaders::place_on_seam(seams, 1, side, at) != expected ? 1 : 0;
                wrong += shaders::place_on_seam(seams, 2, side, at) != -1 ? 1 : 0;
            }
        REQUIRE(wrong == 0);
    }
}

// A node of 64 samples at (3, 5), four octaves below the source's.
TEST_CASE("On a seam places keep their order, nothing else moves, and a node's corners stay") {
    constexpr int kSource = 4, kNodeShift = 10, kLast = 1 << kNodeShift;
    const glm::ivec2 node(3 << kNodeShift, 5 << kNodeShift);
    std::mt19937 random(7);
    Seams seams;
    for (const int side : {0, 2})
        for (int at = 0; at < 64; ++at)
            if (at == 0 || random() % 5 == 0) seams.set(1, side, at);
    shaders::QuadtreeInstance cell{};
    cell.corner = node + glm::ivec2(256, 128);
    cell.lod = 2u << 16;
    const auto moved = [&](int x, int y) {
        return shaders::seamed_place(seams, cell, node + glm::ivec2(x, y), kSource, kNodeShift) - node;
    };
    int before = 0, stands = 0;
    for (int y = 0; y <= kLast; ++y) {
        const glm::ivec2 west = moved(0, y);
        REQUIRE((west.x == 0 && west.y >= before && west.y <= y));
        before = west.y;
        stands += west.y == y ? 1 : 0;
        // The eastern border has no chunk beyond it.
        REQUIRE(moved(kLast, y) == glm::ivec2(kLast, y));
        if (y > 0 && y < kLast) REQUIRE(moved(17, y) == glm::ivec2(17, y));
    }
    CHECK(stands < 64);
    for (const int x : {0, kLast})
        for (const int y : {0, kLast}) CHECK(moved(x, y) == glm::ivec2(x, y));
    CHECK(moved(400, 0).y == 0);
    cell.lod = 0;
    CHECK(moved(0, 33) == glm::ivec2(0, 33));
}
