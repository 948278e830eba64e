#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "ridgeline/select/ground_mask.h"
#include "unit/select_scene.h"

namespace ridgeline::test {
namespace {

using select::GroundLattice;
using select::GroundMask;
using select::GroundRectangle;

GroundRectangle random_terrain(Random& random) {
    const glm::dvec2 corner(uniform(random, -1e6, 1e6), uniform(random, -1e6, 1e6));
    const double size = std::exp2(uniform(random, 2.0, 19.0));
    return {corner, corner + size * glm::dvec2(uniform(random, 0.1, 1.0), uniform(random, 0.1, 1.0))};
}

glm::dvec2 random_place(const GroundRectangle& terrain, double beyond, Random& random) {
    const glm::dvec2 share(uniform(random, -beyond, 1.0 + beyond), uniform(random, -beyond, 1.0 + beyond));
    return terrain.min + share * (terrain.max - terrain.min);
}

// Most of them small and near the eye.
GroundRectangle random_area(const GroundRectangle& terrain, const glm::dvec2& eye, Random& random) {
    const double away = std::exp2(uniform(random, -16.0, 0.0));
    const glm::dvec2 near = glm::clamp(eye, terrain.min, terrain.max);
    const glm::dvec2 corner = glm::mix(near, random_place(terrain, 0.0, random), away);
    const glm::dvec2 size(uniform(random, 0.0, 0.5), uniform(random, 0.0, 0.5));
    return GroundRectangle{corner, corner + away * size * (terrain.max - terrain.min)}.within(terrain);
}

// Open: areas that share a border only do not touch.
bool touch(const GroundRectangle& a, const GroundRectangle& b) {
    return glm::all(glm::lessThan(a.min, b.max)) && glm::all(glm::greaterThan(a.max, b.min));
}

// The size of the cells that decide on an area: of a grid that holds it with cells to spare. At most an eye's
// step outside of its cell, so twice the smallest that could.
double cell_for(const GroundMask& mask, const GroundRectangle& area) {
    const GroundLattice& lattice = mask.lattice();
    const glm::dvec2 eye = lattice.corner_m + (glm::dvec2(mask.centre()) + 0.5) * lattice.cell_m;
    const glm::dvec2 far = glm::max(glm::abs(area.min - eye), glm::abs(area.max - eye));
    const double reach = std::max(far.x, far.y) / lattice.cell_m;
    return lattice.cell_m * std::max(1.0, std::exp2(std::ceil(std::log2(reach / 29.0))));
}

GroundRectangle grown(const GroundRectangle& area, double by) { return {area.min - by, area.max + by}; }

}  // namespace

TEST_CASE("mask: what was marked is seen, and nothing that is more than a cell away from it") {
    Random random(1);
    int seen = 0, unseen = 0;
    for (int i = 0; i < 100; ++i) {
        const GroundRectangle terrain = random_terrain(random);
        const glm::dvec2 eye = random_place(terrain, i % 3 == 0 ? 0.5 : 0.0, random);
        GroundMask mask;
        mask.clear(GroundLattice(terrain), eye);
        std::vector<GroundRectangle> marked;
        for (int n = whole(random, 0, 4); n > 0; --n) marked.push_back(random_area(terrain, eye, random));
        for (const auto& area : marked) mask.mark(area);
        for (int j = 0; j < 200; ++j) {
            const GroundRectangle asked = random_area(terrain, eye, random);
            const auto touches = [&](double by) {
                for (const auto& area : marked)
                    if (touch(grown(asked, by), area)) return true;
                return false;
            };
            const bool any = mask.any(asked);
            (any ? seen : unseen)++;
            if (touches(0.0)) CHECK(any);
            if (any) CHECK(touches(1.0001 * cell_for(mask, asked)));
        }
    }
    CHECK(seen > 1000);
    CHECK(unseen > 1000);
}

TEST_CASE(
    "mask: bits counted elsewhere, each in its innermost grid, are the places that they were counted for") {
    Random random(2);
    for (int i = 0; i < 50; ++i) {
        const GroundRectangle terrain = random_terrain(random);
        const glm::dvec2 eye = random_place(terrain, 0.2, random);
        GroundMask of_bits, of_places;
        of_bits.clear(GroundLattice(terrain), eye);
        of_places.clear(GroundLattice(terrain), eye);
        std::vector<std::uint64_t> words(GroundMask::kWords, 0);
        const glm::ivec2 centre = of_bits.centre();
        for (int n = 0; n < 200; ++n) {
            const glm::dvec2 place =
                glm::mix(eye, random_place(terrain, 0.0, random), std::exp2(uniform(random, -14.0, 0.0)));
            const glm::ivec2 cell = of_bits.lattice().cell(place);
            int grid = 0;
            const auto in = [&](int g) { return (cell >> g) - (centre >> g) + GroundMask::kSide / 2; };
            while (glm::any(glm::lessThan(in(grid), glm::ivec2(0))) ||
                   glm::any(glm::greaterThan(in(grid), glm::ivec2(GroundMask::kSide - 1))))
                ++grid;
            REQUIRE(grid < GroundMask::kGrids);
            words[static_cast<std::size_t>(grid * GroundMask::kSide + in(grid).y)] |= std::uint64_t{1}
                                                                                      << in(grid).x;
            const glm::dvec2 corner =
                of_bits.lattice().corner_m + glm::dvec2(cell) * of_bits.lattice().cell_m;
            of_places.mark(
                {corner + 0.5 * of_bits.lattice().cell_m, corner + 0.5 * of_bits.lattice().cell_m});
            CHECK(of_places.seen_at(place));
        }
        of_bits.mark(std::span<const std::uint64_t, GroundMask::kWords>(words.data(), words.size()));
        CHECK(std::equal(of_bits.words().begin(), of_bits.words().end(), of_places.words().begin()));
    }
}

TEST_CASE("mask: widened by the cell in which a place lies, and by no more than two") {
    Random random(3);
    for (int i = 0; i < 200; ++i) {
        const GroundRectangle terrain = random_terrain(random);
        const glm::dvec2 eye = random_place(terrain, 0.0, random);
        GroundMask mask;
        mask.clear(GroundLattice(terrain), eye);
        const GroundRectangle marked = random_area(terrain, eye, random);
        mask.mark(marked);
        mask.widen();
        for (int j = 0; j < 50; ++j) {
            const GroundRectangle asked = random_area(terrain, eye, random);
            const bool any = mask.any(asked);
            if (touch(grown(asked, mask.lattice().cell_m), marked)) CHECK(any);
            if (any) CHECK(touch(grown(asked, 2.0001 * cell_for(mask, asked)), marked));
        }
    }
}

}  // namespace ridgeline::test
