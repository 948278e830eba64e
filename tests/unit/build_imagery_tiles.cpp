// Imagery tiles of pictures in memory: every texel in its place, with its gutter, at every level, whatever
// the number of threads.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <random>

#include "ridgeline/build/imagery/linear_light.h"
#include "support/small_imagery.h"
#include "support/small_store.h"

using namespace ridgeline;
using build::Texel;

namespace {

test::SmallStore small_store() {
    return test::SmallStore(
        test::ReferenceTerrain(io::Grid(65, 65, 32), test::ReferenceTerrain::random_hills(1, 30, 3)));
}

io::Store opened(const test::SmallStore& small) {
    auto store = io::Store::open(small.directory());
    if (!store) FAIL(store.error().message);
    return std::move(*store);
}

io::ImageryInfo frame_of(std::int64_t width, std::int64_t height) {
    io::ImageryInfo frame;
    frame.width = width;
    frame.height = height;
    return frame;
}

// A colour that BC1 has exactly, another for every number.
Texel exact_colour(std::uint32_t number) {
    const std::uint32_t h = number * 0x9e3779b1u;
    const std::uint32_t r = h >> 27, g = h >> 21 & 63u, b = h >> 16 & 31u;
    return {static_cast<std::uint8_t>(r << 3 | r >> 2), static_cast<std::uint8_t>(g << 2 | g >> 4),
            static_cast<std::uint8_t>(b << 3 | b >> 2), build::kOpaque};
}

// A picture that is constant in every block of the finest level: BC1 keeps it exactly.
Texel by_blocks(std::int64_t x, std::int64_t y) {
    return exact_colour(static_cast<std::uint32_t>(y / 4 * 1000 + x / 4));
}

double linear(int coded) {
    const double c = coded / 255.0;
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}
double coded(double light) {
    return 255.0 * (light <= 0.0031308 ? light * 12.92 : 1.055 * std::pow(light, 1.0 / 2.4) - 0.055);
}

// A texel of a coarser level, straight from the picture: the mean light of what has imagery under it.
struct Mean {
    std::array<double, 3> colour{};
    bool opaque = false;
};
Mean mean_of(const test::MemoryTexels::Colour& picture, const io::ImageryInfo& frame, std::int64_t step,
             std::int64_t column, std::int64_t row) {
    Mean mean;
    double count = 0.0;
    for (std::int64_t y = row * step; y < std::min((row + 1) * step, frame.height); ++y)
        for (std::int64_t x = column * step; x < std::min((column + 1) * step, frame.width); ++x) {
            const Texel texel = picture(x, y);
            if (texel.alpha == 0) continue;
            ++count;
            mean.colour[0] += linear(texel.red);
            mean.colour[1] += linear(texel.green);
            mean.colour[2] += linear(texel.blue);
        }
    mean.opaque = count > 0.0;
    for (double& c : mean.colour) c = mean.opaque ? coded(c / count) : 0.0;
    return mean;
}

}  // namespace

TEST_CASE("imagery: the finest level is the picture, gutters are the neighbours', edges repeat") {
    const auto small = small_store();
    for (const auto& [width, height] : {std::pair{700, 530}, {256, 256}, {1, 1}, {3, 900}, {513, 257}}) {
        CAPTURE(width);
        test::MemoryTexels rows(frame_of(width, height), by_blocks);
        test::add_imagery(small.directory(), rows);
        const io::Store store = opened(small);
        const io::Grid& grid = store.imagery_grid();
        for (std::int64_t i = grid.first(grid.finest()); i < grid.node_count(); ++i) {
            const io::NodeId node = grid.node_at(i);
            const auto blocks = test::read_tile(store, node);
            const io::LatticePoint origin = grid.origin(node);
            int wrong = 0;
            for (int row = -io::kImageryGutter; row < 256 + io::kImageryGutter; ++row)
                for (int column = -io::kImageryGutter; column < 256 + io::kImageryGutter; ++column) {
                    const std::int64_t x = std::clamp<std::int64_t>(origin.x + column, 0, width - 1);
                    const std::int64_t y = std::clamp<std::int64_t>(origin.y + row, 0, height - 1);
                    // A block across the lattice's edge is constant only where the edge falls between blocks.
                    const bool apart = (origin.x + column < width || width % 4 == 0) &&
                                       (origin.y + row < height || height % 4 == 0);
                    if (!apart) continue;
                    wrong += test::texel_of(blocks, column, row) == by_blocks(x, y) ? 0 : 1;
                }
            CHECK(wrong == 0);
        }
        const auto verified = io::verify_store(store, [](std::int64_t, std::int64_t) {});
        if (!verified) FAIL(verified.error().message);
    }
}

TEST_CASE("imagery: every level shows the mean light of what lies under it") {
    const auto small = small_store();
    const io::ImageryInfo frame = frame_of(1400, 1100);
    const test::MemoryTexels::Colour picture = [](std::int64_t x, std::int64_t y) -> Texel {
        // Dark beside bright: the mean of their codes is far from the mean of their light.
        const double slow = std::sin(static_cast<double>(x) / 90.0) * std::cos(static_cast<double>(y) / 70.0);
        const double light = ((x + y) & 1) != 0 ? 215.0 + 30.0 * slow : 30.0 - 20.0 * slow;
        const auto grey = static_cast<std::uint8_t>(light);
        const bool hole = (x / 37 + y / 41) % 5 == 0;
        return {grey, grey, grey, hole ? std::uint8_t{0} : build::kOpaque};
    };
    test::MemoryTexels rows(frame, picture);
    test::add_imagery(small.directory(), rows);
    const io::Store store = opened(small);
    const io::Grid& grid = store.imagery_grid();
    for (int level = 0; level < grid.levels(); ++level) {
        CAPTURE(level);
        const std::int64_t step = grid.step(level);
        double squares = 0.0, count = 0.0;
        int wrong_holes = 0;
        for (std::int64_t i = grid.first(level); i < grid.first(level + 1); ++i) {
            const io::NodeId node = grid.node_at(i);
            const auto blocks = test::read_tile(store, node);
            for (int row = 0; row < 256; row += 3)
                for (int column = 0; column < 256; column += 3) {
                    const std::int64_t x = node.x * 256 + column, y = node.y * 256 + row;
                    if (x * step >= frame.width || y * step >= frame.height) continue;
                    const Mean mean = mean_of(picture, frame, step, x, y);
                    const Texel texel = test::texel_of(blocks, column, row);
                    if (mean.opaque != (texel.alpha != 0)) {
                        ++wrong_holes;
                        continue;
                    }
                    if (!mean.opaque) continue;
                    const std::array<double, 3> got = {1.0 * texel.red, 1.0 * texel.green, 1.0 * texel.blue};
                    for (std::size_t c = 0; c < 3; ++c)
                        squares += (got[c] - mean.colour[c]) * (got[c] - mean.colour[c]);
                    count += 3.0;
                }
        }
        CHECK(wrong_holes == 0);
        CHECK(count > 0.0);
        // What BC1's five bits of red leave; means of codes would be 40 off.
        CHECK(std::sqrt(squares / count) < 4.0);
    }
}

TEST_CASE("imagery: nodes outside the picture's imagery do not exist, their parents and gutters do") {
    const auto small = small_store();
    test::MemoryTexels rows(frame_of(1024, 1024), [](std::int64_t x, std::int64_t y) -> Texel {
        return x >= 300 && x < 512 && y < 200 ? by_blocks(x, y) : Texel{};
    });
    test::add_imagery(small.directory(), rows);
    const io::Store store = opened(small);
    CHECK(store.imagery_record({0, 0, 0}).has_data());
    CHECK(store.imagery_record({1, 0, 0}).has_data());
    CHECK_FALSE(store.imagery_record({1, 1, 0}).has_data());
    CHECK(store.imagery_record({2, 1, 0}).has_data());
    CHECK(store.imagery_record({2, 1, 0}).has_holes());
    CHECK_FALSE(store.imagery_record({2, 2, 0}).has_data());
    CHECK_FALSE(store.imagery_record({2, 0, 0}).has_data());
    CHECK(store.info().imagery->tiles == 3);
    const auto blocks = test::read_tile(store, {2, 1, 0});
    CHECK(test::texel_of(blocks, 43, 0).alpha == 0);
    CHECK(test::texel_of(blocks, 44, 0) == by_blocks(300, 0));
    CHECK(test::texel_of(blocks, 256, 0).alpha == 0);
}

TEST_CASE("imagery: whatever the number of threads, the bytes are the same") {
    const auto files = [](const test::SmallStore& small) {
        std::string all;
        for (const char* name : {"imagery.bin", "imagery.tiles", "terrain.json"}) {
            std::ifstream in(small.directory() / name, std::ios::binary);
            all += std::string(std::istreambuf_iterator<char>(in), {});
        }
        return all;
    };
    std::mt19937 random(7);
    std::vector<Texel> texels(1300 * 900);
    for (Texel& texel : texels) {
        const auto bits = random();
        texel = {static_cast<std::uint8_t>(bits), static_cast<std::uint8_t>(bits >> 8),
                 static_cast<std::uint8_t>(bits >> 16), bits >> 24 < 9 ? std::uint8_t{0} : build::kOpaque};
    }
    std::string first;
    for (const int workers : {1, 2, 5}) {
        const auto small = small_store();
        test::MemoryTexels rows(frame_of(1300, 900), [&](std::int64_t x, std::int64_t y) {
            return texels[static_cast<std::size_t>(y * 1300 + x)];
        });
        test::add_imagery(small.directory(), rows, workers);
        if (first.empty()) first = files(small);
        CHECK(files(small) == first);
    }
}

TEST_CASE("imagery: a mean of equal texels is that texel, holes do not count") {
    for (int value = 0; value < 256; ++value) {
        const auto v = static_cast<std::uint8_t>(value);
        const Texel texel{v, static_cast<std::uint8_t>(255 - value), v, build::kOpaque};
        for (int holes = 0; holes < 16; ++holes) {
            std::array<Texel, 4> from;
            for (int i = 0; i < 4; ++i)
                from[static_cast<std::size_t>(i)] = (holes >> i & 1) != 0 ? Texel{9, 9, 9, 0} : texel;
            std::array<Texel, 1> to;
            build::halve(from, 2, to);
            CHECK(to[0] == (holes == 15 ? Texel{} : texel));
        }
    }
}
