// The imagery's shader functions, run on the CPU: the very text that the GPU runs.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "ridgeline/shaders/lib/virtual_texture.h"

using namespace ridgeline::shaders;

namespace {

double uniform(std::mt19937& random, double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random);
}

// A lattice far from its corner, and an eye on it.
struct Scene {
    explicit Scene(std::mt19937& random) {
        texels_per_metre = {uniform(random, 0.05, 4.0), uniform(random, 0.05, 4.0)};
        size = {1000 + random() % 2'000'000, 1000 + random() % 2'000'000};
        eye = {uniform(random, 0.0, size.x), uniform(random, 0.0, size.y)};
        levels = 1;
        while ((256 << (levels - 1)) < std::min(size.x, size.y)) ++levels;
        const glm::dvec2 cell = glm::floor(eye);
        imagery.eye_rest_and_scale = vec4(eye - cell, texels_per_metre);
        imagery.eye_cell_and_size = ivec4(ivec2(cell), size);
        imagery.table = ivec4(levels - 1, 6, 6, 0);
    }
    glm::dvec2 texels_per_metre, eye;
    glm::ivec2 size;
    int levels = 1;
    ImageryUniforms imagery{};
};

}  // namespace

TEST_CASE("a place on the imagery is where double precision has it, to a thousandth of a pixel") {
    std::mt19937 random(1);
    for (int i = 0; i < 100000; ++i) {
        const Scene scene(random);
        const double reach_m = std::exp(uniform(random, 0.0, 12.0));
        const glm::dvec2 metres(uniform(random, -reach_m, reach_m), uniform(random, -reach_m, reach_m));
        // What the shader gets is a float of it.
        const vec2 given(metres);
        const glm::dvec2 expected =
            scene.eye + glm::dvec2(given.x, -given.y) * glm::dvec2(vec2(scene.texels_per_metre));
        const ImageryPlace place = imagery_place(scene.imagery, given);
        REQUIRE(place.past.x >= 0.0f);
        REQUIRE(place.past.x <= 1.0f);
        const glm::dvec2 found = glm::dvec2(place.cell) + glm::dvec2(place.past);
        // A pixel covers about 1/700 of its distance.
        const double pixel_texels =
            std::max(1.0, reach_m * std::max(scene.texels_per_metre.x, scene.texels_per_metre.y) / 700.0);
        REQUIRE(std::abs(found.x - expected.x) < 1e-3 * pixel_texels);
        REQUIRE(std::abs(found.y - expected.y) < 1e-3 * pixel_texels);
        if (glm::all(glm::greaterThan(expected, glm::dvec2(1.0))) &&
            glm::all(glm::lessThan(expected, glm::dvec2(scene.size) - 1.0)))
            REQUIRE(on_imagery(scene.imagery, place.cell));
        if (expected.x < -1.0 || expected.y > scene.size.y + 1.0)
            REQUIRE_FALSE(on_imagery(scene.imagery, place.cell));
    }
}

TEST_CASE("a tap lies on its texel in the tile that the page names, whatever the tile's level") {
    std::mt19937 random(2);
    for (int i = 0; i < 100000; ++i) {
        const Scene scene(random);
        const glm::dvec2 at(uniform(random, 0.0, scene.size.x), uniform(random, 0.0, scene.size.y));
        const glm::dvec2 cell = glm::floor(at);
        const ImageryPlace place{ivec2(cell), vec2(at - cell)};
        const int c = static_cast<int>(random() % static_cast<unsigned>(scene.levels));
        const uint slot = random() % 2000;
        const ImageryTap tap =
            imagery_tap(place, (slot + 1) | static_cast<uint>(c) << kPageCoarsenessShift, 0.0f, 0.0f);
        CHECK(tap.layer == static_cast<float>(slot));
        const double side = std::ldexp(256.0, c);
        const glm::dvec2 in_tile = (at - glm::floor(at / side) * side) / std::ldexp(1.0, c);
        REQUIRE(std::abs(tap.at.x * 264.0 - 4.0 - in_tile.x) < 1e-3);
        REQUIRE(std::abs(tap.at.y * 264.0 - 4.0 - in_tile.y) < 1e-3);
        REQUIRE(tap.gradient * 264.0f == doctest::Approx(std::ldexp(1.0, -c)));
    }
}

TEST_CASE("the wanted coarseness makes texels a pixel wide, and no more blurred than a long print asks for") {
    CHECK(wanted_coarseness({1.0f, 0.0f}, {0.0f, 1.0f}, 8.0f) == doctest::Approx(0.0));
    CHECK(wanted_coarseness({4.0f, 0.0f}, {0.0f, 4.0f}, 1.0f) == doctest::Approx(2.0));
    // Four times longer than wide: sharp with room for that, else by its length.
    CHECK(wanted_coarseness({0.0f, 8.0f}, {2.0f, 0.0f}, 4.0f) == doctest::Approx(1.0));
    CHECK(wanted_coarseness({0.0f, 8.0f}, {2.0f, 0.0f}, 1.0f) == doctest::Approx(3.0));
    CHECK(wanted_coarseness({0.0f, 32.0f}, {2.0f, 0.0f}, 4.0f) == doctest::Approx(3.0));
    CHECK(wanted_coarseness({0.0f, 0.0f}, {0.0f, 0.0f}, 4.0f) < -10.0f);
}

TEST_CASE(
    "a window's least coarseness holds every place, and no place within sixteen nodes is coarser for it") {
    CHECK(window_coarseness(0, 6, kTileTexelBits) <= 0);
    std::mt19937 random(3);
    for (int i = 0; i < 100000; ++i) {
        const int eye = static_cast<int>(random() % 100'000'000),
                  cells = static_cast<int>(random() % (1u << (random() % 26)));
        const int place = random() % 2 ? eye + cells : eye - cells;
        const int c = std::max(window_coarseness(cells, 6, kTileTexelBits), 0), shift = 8 + c;
        const int nodes = (place >> shift) - (eye >> shift);
        REQUIRE(nodes >= -32);
        REQUIRE(nodes <= 31);
        if (cells < 16 * 256) REQUIRE(c == 0);
    }
}

TEST_CASE("lookups along a print stay within the gutter, whatever the print") {
    std::mt19937 random(4);
    for (int i = 0; i < 100000; ++i) {
        const auto any = [&] {
            return vec2(
                static_cast<float>(std::exp(uniform(random, -8.0, 20.0)) * (random() % 2 ? 1.0 : -1.0)),
                static_cast<float>(std::exp(uniform(random, -8.0, 20.0))));
        };
        vec2 dx = any(), dy = any();
        const auto most = static_cast<float>(uniform(random, -4.0, 20.0));
        const float coarseness = std::min(wanted_coarseness(dx, dy, 4.0f), most);
        const float share = print_share(dx, dy, coarseness, 4.0f);
        REQUIRE(share <= 1.0f);
        dx *= share;
        dy *= share;
        // At or above what is wanted; the coarsest there is may be finer.
        const int c = std::clamp(static_cast<int>(std::floor(coarseness)), 0, 9);
        const ImageryTap tap = imagery_tap(
            {{0, 0}, {0.0f, 0.0f}}, 1u | static_cast<uint>(c) << kPageCoarsenessShift, coarseness, 0.0f);
        const ImageryPrint print = imagery_print(dx, dy, {4.0f, 4.0f});
        REQUIRE(print.taps >= 1);
        REQUIRE(print.taps <= 4);
        const vec2 farthest =
            print.step * tap.gradient * (0.5f * static_cast<float>(print.taps - 1)) * 264.0f;
        // And a texel of mip 1 for the filter.
        REQUIRE(length(farthest) + 1.0f <= 4.001f);
    }
}

TEST_CASE("a late tile begins as its parent's texels and is sharp in the end") {
    const ImageryPlace place{{100, 100}, {0.5f, 0.5f}};
    const uint page = 1u | 2u << kPageCoarsenessShift;
    const auto detail = [&](float coarseness, float blur) {
        // Of the texture's mips: a print that wants this coarseness has 2^coarseness finest texels to a
        // pixel.
        return std::log2(std::exp2(coarseness) * imagery_tap(place, page, coarseness, blur).gradient *
                         264.0f);
    };
    for (const float coarseness : {0.5f, 2.0f, 2.25f, 2.75f}) {
        CHECK(detail(coarseness, 0.0f) == doctest::Approx(coarseness - 2.0f));
        CHECK(detail(coarseness + 4.0f, 0.0f) == doctest::Approx(1.0f));
        CHECK(detail(coarseness, 1.0f) == doctest::Approx(1.0f));
        CHECK(detail(coarseness, 0.5f) == doctest::Approx(std::max(coarseness - 2.0f, 0.5f)));
    }
}
