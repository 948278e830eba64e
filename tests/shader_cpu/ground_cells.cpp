#include "ridgeline/shaders/lib/ground_cells.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "ridgeline/select/ground_mask.h"

namespace ridgeline::shaders {
namespace {

using Random = std::mt19937_64;
double uniform(Random& random, double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
}

TEST_CASE("ordered bits have the order of the floats, and go back to them") {
    Random random(1);
    const auto any = [&] {
        const double size = std::exp2(uniform(random, -120.0, 120.0));
        return static_cast<float>(uniform(random, 0.0, 1.0) < 0.5 ? size : -size);
    };
    for (int i = 0; i < 10000; ++i) {
        const float a = any(), b = any();
        CHECK((a < b) == (ordered_bits(a) < ordered_bits(b)));
        CHECK(from_ordered_bits(ordered_bits(a)) == a);
        CHECK(ordered_bits(a) != 0u);
    }
    CHECK(from_ordered_bits(ordered_bits(0.0f)) == 0.0f);
    CHECK(ordered_bits(-std::numeric_limits<float>::infinity()) > 0u);
}

TEST_CASE("a place's bit is the mask's, to a rounding of floats beside a cell's border") {
    Random random(2);
    int differing = 0;
    for (int i = 0; i < 300; ++i) {
        const dvec2 corner(uniform(random, -1e5, 1e5), uniform(random, 1e6, 3e6));
        const dvec2 size(uniform(random, 1e3, 4e5), uniform(random, 1e3, 4e5));
        const select::GroundLattice lattice({corner, corner + size});
        const dvec2 eye = corner + dvec2(uniform(random, -0.2, 1.2), uniform(random, -0.2, 1.2)) * size;
        const ivec2 centre = lattice.cell(eye);
        const GroundCells cells{vec2(lattice.corner_m + dvec2(centre) * lattice.cell_m - eye),
                                static_cast<float>(lattice.cells_per_m), centre, lattice.cells};
        for (int j = 0; j < 30; ++j) {
            const dvec2 place = corner + dvec2(uniform(random, 0.0, 1.0), uniform(random, 0.0, 1.0)) * size;
            const ivec2 cell = ground_cell(vec2(place - eye), cells);
            const int grid = innermost_grid(cell, centre);
            const ivec2 at = cell_in_grid(cell, centre, grid);
            CHECK(is_in_grid(at));
            std::array<std::uint32_t, kGroundWords> words{};
            words[static_cast<std::size_t>(ground_word(at, grid))] |= ground_bit(at);
            std::array<std::uint64_t, select::GroundMask::kWords> both;
            std::memcpy(both.data(), words.data(), sizeof both);
            select::GroundMask mask;
            mask.clear(lattice, eye);
            mask.mark(both);
            if (!mask.seen_at(place)) ++differing;
            mask.widen();
            // At a grid's own border the next one knows.
            const double by = lattice.cell_m * std::exp2(grid);
            CHECK(mask.any({place - by, place + by}));
        }
    }
    CHECK(differing < 9000 / 20);
}

}  // namespace
}  // namespace ridgeline::shaders
