// The clipmap's bytes against a clipmap that is one: textures addressed round their edges, every block of
// every window looked at after each step.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "ridgeline/app/bench/clipmap.h"

using namespace ridgeline::app;

namespace {

// One level. A place of the texture holds one block, or nothing yet; a block of the data that the window
// wants and that is not in its place is sent there.
class SlowWindow {
  public:
    SlowWindow(const ClipmapLevel& level, const ClipmapFormat& format)
        : level_(level), format_(format), size_(slow_size(level.texel_m.x), slow_size(level.texel_m.y)) {
        held_.assign(static_cast<std::size_t>(size_.x * size_.y), BlockPlace(kNothing));
    }

    std::int64_t move_to(const glm::dvec2& from_corner_m) {
        std::int64_t bytes = 0;
        const BlockPlace first(slow_first(from_corner_m.x, level_.texel_m.x),
                               slow_first(from_corner_m.y, level_.texel_m.y));
        for (std::int64_t y = first.y; y < first.y + size_.y; ++y)
            for (std::int64_t x = first.x; x < first.x + size_.x; ++x) bytes += want({x, y});
        return bytes;
    }

    double reach_m() const { return level_.reach_m; }
    BlockPlace size() const { return size_; }

  private:
    static constexpr std::int64_t kNothing = std::numeric_limits<std::int64_t>::min();

    // The fewest blocks that hold the reach to both sides of every eye.
    std::int64_t slow_size(double texel_m) const {
        const double reach_blocks = level_.reach_m / texel_m / format_.block_texels;
        std::int64_t blocks = 1;
        while (static_cast<double>(blocks - 1) < 2.0 * reach_blocks) ++blocks;
        return blocks;
    }
    // The block in which the reach begins.
    std::int64_t slow_first(double at_m, double texel_m) const {
        const double texels = at_m / texel_m - level_.reach_m / texel_m;
        return static_cast<std::int64_t>(std::floor(texels / format_.block_texels));
    }
    bool has_data(const BlockPlace& block) const {
        const BlockPlace texel = block * std::int64_t{format_.block_texels};
        return texel.x >= 0 && texel.y >= 0 && texel.x < level_.texels.x && texel.y < level_.texels.y;
    }
    std::int64_t want(const BlockPlace& block) {
        const BlockPlace place = (block % size_ + size_) % size_;
        BlockPlace& held = held_[static_cast<std::size_t>(place.y * size_.x + place.x)];
        if (held == block) return 0;
        held = block;
        return has_data(block) ? format_.block_bytes : 0;
    }

    ClipmapLevel level_;
    ClipmapFormat format_;
    BlockPlace size_;
    std::vector<BlockPlace> held_;
};

class Random {
  public:
    explicit Random(std::uint64_t seed) : random_(seed) {}
    double between(double least, double most) {
        return least + (most - least) * static_cast<double>(random_() >> 11) * 0x1p-53;
    }
    std::int64_t whole(std::int64_t least, std::int64_t most) {
        return least + static_cast<std::int64_t>(random_() % static_cast<std::uint64_t>(most - least + 1));
    }

  private:
    std::mt19937_64 random_;
};

std::vector<ClipmapLevel> random_levels(Random& random) {
    std::vector<ClipmapLevel> levels;
    BlockPlace texels(random.whole(3, 40), random.whole(3, 40));
    glm::dvec2 texel_m(random.between(4.0, 40.0), random.between(4.0, 40.0));
    const std::int64_t count = random.whole(1, 5);
    for (std::int64_t i = 0; i < count; ++i) {
        levels.push_back({texels, texel_m, random.between(0.0, 30.0) * std::max(texel_m.x, texel_m.y)});
        texels = texels * std::int64_t{2} - std::int64_t{random.whole(0, 1)};
        texel_m /= 2.0;
    }
    return levels;
}

}  // namespace

TEST_CASE("clipmap: the bytes of every step are those of toroidal textures looked at block by block") {
    const ClipmapFormat formats[] = {{1, 3}, {4, 8}, {1, 6}, {3, 5}};
    std::int64_t resting = 0, sent = 0;
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        CAPTURE(seed);
        Random random(seed);
        const ClipmapFormat& format = formats[seed % 4];
        const auto levels = random_levels(random);
        Clipmap clipmap(levels, format);
        std::vector<SlowWindow> slow;
        for (auto level = levels.begin() + 1; level != levels.end(); ++level)
            slow.emplace_back(*level, format);
        const glm::dvec2 size_m = glm::dvec2(levels[0].texels) * levels[0].texel_m;
        glm::dvec2 eye = size_m * glm::dvec2(random.between(-0.3, 1.3), random.between(-0.3, 1.3));
        for (int step = 0; step < 40; ++step) {
            CAPTURE(step);
            const double above_m = random.between(0.0, 1.5 * size_m.x);
            std::int64_t bytes = 0;
            for (SlowWindow& window : slow) {
                if (above_m < window.reach_m())
                    bytes += window.move_to(eye);
                else
                    ++resting;
            }
            REQUIRE(clipmap.move_to(eye, above_m) == bytes);
            sent += bytes;
            // Mostly steps of a few texels, now and then a leap, now and then none.
            const double stride = step % 9 == 8 ? 0.8 : step % 5 == 4 ? 0.0 : 0.02;
            eye += stride * size_m * glm::dvec2(random.between(-1.0, 1.0), random.between(-1.0, 1.0));
        }
        for (std::size_t i = 0; i < slow.size(); ++i)
            CHECK(clipmap.windows()[i].size_texels() == slow[i].size() * std::int64_t{format.block_texels});
    }
    CHECK(sent > 0);
    CHECK(resting > 0);
}

TEST_CASE("clipmap: a window holds all within its reach, wherever the eye is, and not a block to spare") {
    Random random(7);
    for (int round = 0; round < 2000; ++round) {
        const ClipmapFormat format{static_cast<int>(random.whole(1, 5)), 8};
        const ClipmapLevel level{{100, 100}, {1.5, 2.5}, random.between(0.0, 80.0)};
        ClipmapWindow window(level, format);
        const glm::dvec2 eye(random.between(-50.0, 150.0), random.between(-50.0, 150.0));
        window.move_to(eye);
        const glm::dvec2 reach = level.reach_m / level.texel_m;
        const double side = format.block_texels;
        for (int axis = 0; axis < 2; ++axis) {
            const auto first = static_cast<double>(window.window().first[axis]) * side;
            const auto end = static_cast<double>(window.window().end[axis]) * side;
            CHECK(first <= eye[axis] - reach[axis] + 1e-9);
            CHECK(end >= eye[axis] + reach[axis] - 1e-9);
            CHECK(end - first < 2.0 * reach[axis] + 2.0 * side + 1e-9);
        }
    }
}

TEST_CASE(
    "clipmap: a step of one block along an axis sends one strip, both axes an L, standing still nothing") {
    const ClipmapFormat format{4, 8};
    ClipmapWindow window({{4000, 4000}, {1.0, 1.0}, 128.0}, format);
    const std::int64_t n = 65;  // 256 texels and a block
    CHECK(window.size_texels() == BlockPlace(4 * n));
    CHECK(window.move_to({2000.0, 2000.0}) == n * n * 8);
    CHECK(window.move_to({2000.0, 2000.0}) == 0);
    CHECK(window.move_to({2003.9, 2000.0}) == 0);
    CHECK(window.move_to({2004.0, 2000.0}) == n * 8);
    CHECK(window.move_to({2008.0, 1996.0}) == (2 * n - 1) * 8);
    CHECK(window.move_to({9000.0, 9000.0}) == 0);  // beyond the data
}
