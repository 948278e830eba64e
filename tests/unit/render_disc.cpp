// The disc's triangles and heights without a GPU: that rings are one surface, that the CPU finds the triangle
// the GPU draws, and that snapping moves nothing.
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "ridgeline/pager/heights_texels.h"
#include "ridgeline/render/disc_grid.h"
#include "ridgeline/shaders/lib/disc.h"
#include "unit/whole_heights.h"

using namespace ridgeline;
using namespace ridgeline::render;
using namespace ridgeline::test;

namespace {

constexpr int kRadius = shaders::kDiscRadius;
using Corner = std::pair<int, int>;

glm::ivec2 random_cell(std::mt19937& random) {
    return {static_cast<int>(random() % 5000), static_cast<int>(random() % 5000)};
}

// The finest samples at which the triangles of all rings have their corners, three a triangle.
std::vector<glm::ivec2> all_corners(const DiscGrid& grid, const glm::ivec2& eye, const RingRange& rings) {
    std::vector<glm::ivec2> corners;
    for (int ring = rings.innermost; ring <= rings.outermost; ++ring) {
        const glm::ivec2 centre = ring_centre(eye, ring);
        const auto hole = static_cast<std::size_t>(ring_hole(eye, ring, rings.innermost));
        for (const RingSector& sector : grid.sectors[hole])
            for (std::uint32_t i = 0; i < sector.count; ++i) {
                const DiscVertex& vertex = grid.vertices[grid.indices[sector.first + i]];
                const glm::ivec2 offset(vertex.x, vertex.y);
                REQUIRE(glm::all(glm::greaterThanEqual(offset, sector.least)));
                REQUIRE(glm::all(glm::lessThanEqual(offset, sector.most)));
                corners.push_back((centre + offset) << ring);
            }
    }
    return corners;
}

double surface_at(const WholeHeights& heights, const glm::dvec2& eye, float above, const glm::dvec2& place) {
    const shaders::DiscUniforms disc = uniforms_at(eye, above);
    const int innermost = ring_range(static_cast<double>(above), 0.0).innermost;
    const DiscTriangle triangle =
        disc_triangle(kRadius, glm::ivec2(disc.eye_cell_and_size), innermost, place);
    double height = 0.0;
    for (std::size_t i = 0; i < 3; ++i)
        height += triangle.weights[i] * static_cast<double>(shaders::disc_height(
                                            heights, disc, triangle.cells[i], triangle.ring, 0));
    return height;
}

}  // namespace

TEST_CASE("The rings of a disc are one surface: every edge within has a triangle on either side, once") {
    const DiscGrid grid = make_disc_grid(kRadius);
    std::mt19937 random(1);
    for (int round = 0; round < 6; ++round) {
        const glm::ivec2 eye = random_cell(random);
        const RingRange rings = {static_cast<int>(random() % 3), 4};
        const auto corners = all_corners(grid, eye, rings);
        std::set<std::pair<Corner, Corner>> edges;
        double area = 0.0;
        for (std::size_t i = 0; i < corners.size(); i += 3) {
            const glm::dvec2 a(corners[i]), b(corners[i + 1]), c(corners[i + 2]);
            const double twice = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
            // Rows count southwards: counter-clockwise from above.
            REQUIRE(twice < 0.0);
            area -= 0.5 * twice;
            for (std::size_t j = 0; j < 3; ++j) {
                const glm::ivec2 from = corners[i + j], to = corners[i + (j + 1) % 3];
                REQUIRE(edges.insert({{from.x, from.y}, {to.x, to.y}}).second);
            }
        }
        // What is left without a neighbour is the outermost border.
        const glm::dvec2 middle =
            glm::dvec2(ring_centre(eye, rings.outermost) + 2) * std::exp2(rings.outermost);
        double border_area = 0.0;
        for (const auto& [from, to] : edges) {
            if (edges.contains({to, from})) continue;
            const glm::dvec2 a = glm::dvec2(from.first, from.second) - middle,
                             b = glm::dvec2(to.first, to.second) - middle;
            REQUIRE(glm::length(a) > (kRadius - 6) * std::exp2(rings.outermost));
            border_area += 0.5 * (a.y * b.x - a.x * b.y);
        }
        CHECK(area == doctest::Approx(border_area));
    }
}

TEST_CASE("A ring has wholly turned into the next where it ends, which has not begun to turn there") {
    const DiscGrid grid = make_disc_grid(kRadius);
    std::mt19937 random(2);
    for (int round = 0; round < 40; ++round) {
        const glm::ivec2 eye = random_cell(random);
        const int innermost = static_cast<int>(random() % 4);
        // As high as the innermost ring is drawn at all.
        const float highest = shaders::kDiscMorphEnd * std::exp2(static_cast<float>(innermost));
        const float least = innermost == 0 ? 0.0f : 0.5f * highest;
        const float above = std::uniform_real_distribution<float>(least, highest)(random);
        const glm::dvec2 past(std::generate_canonical<double, 24>(random),
                              std::generate_canonical<double, 24>(random));
        const shaders::DiscUniforms disc = uniforms_at(glm::dvec2(eye) + past, above);
        for (int ring = innermost; ring < innermost + 4; ++ring) {
            std::set<Corner> inner, outer;
            for (const auto& at : all_corners(grid, eye, {ring, ring})) inner.insert({at.x, at.y});
            const auto hole = static_cast<std::size_t>(ring_hole(eye, ring + 1, innermost));
            for (const RingSector& sector : grid.sectors[hole])
                for (std::uint32_t i = 0; i < sector.count; ++i) {
                    const DiscVertex& vertex = grid.vertices[grid.indices[sector.first + i]];
                    const glm::ivec2 at = (ring_centre(eye, ring + 1) + glm::ivec2(vertex.x, vertex.y))
                                          << (ring + 1);
                    outer.insert({at.x, at.y});
                }
            int shared = 0;
            for (const Corner& at : outer) {
                if (!inner.contains(at)) continue;
                ++shared;
                const glm::ivec2 cell(at.first, at.second);
                REQUIRE(shaders::ring_weight(shaders::ring_distance(disc, cell, ring)) == 1.0f);
                REQUIRE(shaders::ring_weight(shaders::ring_distance(disc, cell, ring + 1)) == 0.0f);
            }
            REQUIRE(shared > 100);
        }
    }
}

TEST_CASE("At a fixed place the surface stays where it is when the rings snap") {
    const WholeHeights heights{rough};
    std::mt19937 random(3);
    std::uniform_real_distribution<double> near(-700.0, 700.0);
    double most = 0.0, most_coarse = 0.0;
    for (int snap = 0; snap < 200; ++snap) {
        // A place where every ring snaps at once, or the finest alone.
        const int multiple = snap % 2 == 0 ? 64 : 4;
        const glm::dvec2 line = glm::dvec2(random_cell(random) / 2 / multiple * multiple) + 1000.0;
        const glm::dvec2 at =
            glm::floor(line / static_cast<double>(multiple)) * static_cast<double>(multiple);
        const float above = 3.0f + static_cast<float>(snap % 5) * 40.0f;
        constexpr double kStep = 1e-3;
        for (int i = 0; i < 200; ++i) {
            const glm::dvec2 place = at + glm::dvec2(near(random), near(random));
            const double before = surface_at(heights, at - kStep, above, place);
            const double after = surface_at(heights, at + kStep, above, place);
            most = std::max(most, std::abs(after - before));
            most_coarse = std::max(
                most_coarse, std::abs(before - rough(static_cast<int>(place.x), static_cast<int>(place.y))));
        }
    }
    // Quanta. What remains is the eye's own move of a few thousandths of a sample.
    CHECK(most < 0.1);
    // The surface is one, and no copy of the terrain.
    CHECK(most_coarse > 20.0);
}

TEST_CASE("The CPU finds the triangle that a place lies in") {
    const DiscGrid grid = make_disc_grid(kRadius);
    std::mt19937 random(4);
    const glm::ivec2 eye = random_cell(random);
    std::set<std::set<Corner>> drawn;
    const auto corners = all_corners(grid, eye, {0, 3});
    for (std::size_t i = 0; i < corners.size(); i += 3) {
        std::set<Corner> triangle;
        for (std::size_t j = 0; j < 3; ++j) triangle.insert({corners[i + j].x, corners[i + j].y});
        drawn.insert(triangle);
    }
    std::uniform_real_distribution<double> near(-480.0, 480.0);
    for (int i = 0; i < 4000; ++i) {
        const glm::dvec2 place = glm::dvec2(eye) + glm::dvec2(near(random), near(random));
        const DiscTriangle found = disc_triangle(kRadius, eye, 0, place);
        std::set<Corner> triangle;
        glm::dvec2 there(0.0);
        for (std::size_t j = 0; j < 3; ++j) {
            triangle.insert({found.cells[j].x, found.cells[j].y});
            REQUIRE(found.weights[j] >= -1e-9);
            there += found.weights[j] * glm::dvec2(found.cells[j]);
        }
        REQUIRE(drawn.contains(triangle));
        REQUIRE(glm::distance(there, place) < 1e-6);
    }
}

TEST_CASE(
    "Heights are packed as they are, or filtered to twice their spacing, with the cells that are terrain") {
    io::HeightsTile tile;
    tile.quads = 32;
    tile.all_valid = false;
    const int side = pager::heights_texels_side(tile.quads);
    std::mt19937 random(5);
    for (int i = 0; i < side * side; ++i)
        tile.quanta.push_back(static_cast<std::int32_t>(random() % 20000) - 10000);
    tile.sample_valid.assign(tile.quanta.size(), 1);
    for (int i = 0; i < 32 * 32; ++i) tile.cell_valid.push_back(random() % 2);
    std::vector<std::byte> raw(pager::heights_texels_bytes(32)), filtered(raw.size());
    pager::pack_heights(tile, pager::HeightsFilter::none, raw);
    pager::pack_heights(tile, pager::HeightsFilter::twice_spacing, filtered);
    const auto texel = [side](const std::vector<std::byte>& texels, int column, int row) {
        std::int32_t value = 0;
        std::memcpy(&value, texels.data() + 4 * ((row + 3) * side + column + 3), 4);
        return value;
    };
    for (int row = -2; row < 34; ++row)
        for (int column = -2; column < 34; ++column) {
            REQUIRE((texel(raw, column, row) >> 1) == 16 * tile.quanta[tile.at(column, row)]);
            std::int32_t sum = 0;
            for (int y = -1; y <= 1; ++y)
                for (int x = -1; x <= 1; ++x)
                    sum += (x == 0 ? 2 : 1) * (y == 0 ? 2 : 1) * tile.quanta[tile.at(column + x, row + y)];
            REQUIRE((texel(filtered, column, row) >> 1) == sum);
            if (row < 0 || column < 0 || row > 31 || column > 31) continue;
            REQUIRE((texel(raw, column, row) & 1) ==
                    tile.cell_valid[static_cast<std::size_t>(row * 32 + column)]);
        }
}
