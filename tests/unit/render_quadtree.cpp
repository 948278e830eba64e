// The quadtree surface's cells without a GPU: that levels are balanced and no finer than asked for, and that all
// cells together are one surface.
#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "ridgeline/pager/heights_texels.h"
#include "ridgeline/render/quadtree_patch.h"
#include "ridgeline/shaders/lib/quadtree_shape.h"
#include "ridgeline/shaders/lib/quadtree_vertex.h"
#include "unit/render_quadtree_scene.h"

using namespace ridgeline;
using namespace ridgeline::render;
using namespace ridgeline::test;

namespace {

using Corner = std::pair<int, int>;

// What all cells draw together: triangles of finest samples.
struct Triangle {
    std::array<shaders::QuadtreeVertex, 3> corner;
    std::int64_t twice_area() const {
        const glm::i64vec2 a = corner[1].cell - corner[0].cell, b = corner[2].cell - corner[0].cell;
        // Rows go southwards: positive where it goes round anticlockwise, seen from above.
        return a.y * b.x - a.x * b.y;
    }
};

std::vector<Triangle> triangles_of(const LodScene& scene) {
    const int quads = 1 << scene.view.eye_cell.w;
    const auto indices = quadtree_patch(quads);
    std::vector<Triangle> triangles;
    for (const auto& cell : scene.lod.instances())
        for (std::size_t i = 0; i < indices.size(); i += 3) {
            Triangle triangle;
            for (std::size_t c = 0; c < 3; ++c) {
                const int at = indices[i + c];
                triangle.corner[c] =
                    shaders::quadtree_vertex(cell, {at % (quads + 1), at / (quads + 1)}, quads);
            }
            triangles.push_back(triangle);
        }
    return triangles;
}

}  // namespace

namespace {

// Finest cells of the raster that not one entry covers where there is ground, or any where there is none.
int wrongly_covered(const LodScene& scene) {
    const int cell = 1 << scene.view.eye_cell.w;
    const auto cells = [&](std::int64_t samples) { return static_cast<int>((samples - 2) / cell + 1); };
    const int columns = cells(scene.grid.width()), rows = cells(scene.grid.height());
    std::vector<int> times(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    const auto at = [&](int column, int row) {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
               static_cast<std::size_t>(column);
    };
    for (const auto& block : scene.blocks.blocks())
        for (int e = 0; e < shaders::kQuadtreeEntries; ++e) {
            const glm::ivec2 place = shaders::entry_place(e);
            if (!shaders::has_entry(block, place)) continue;
            const int side = 1 << block.coarseness;
            const glm::ivec2 first = (block.node * shaders::kQuadtreeSide + place) * side;
            for (int row = first.y; row < std::min(first.y + side, rows); ++row)
                for (int column = first.x; column < std::min(first.x + side, columns); ++column)
                    ++times[at(column, row)];
        }
    int wrong = 0;
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            const bool ground = scene.has_ground(std::int64_t{column} * cell, std::int64_t{row} * cell);
            wrong += times[at(column, row)] == (ground ? 1 : 0) ? 0 : 1;
        }
    return wrong;
}

}  // namespace

TEST_CASE("blocks cover all ground with data once, and neighbours are no more than a level apart") {
    Random random(1);
    for (int round = 0; round < 60; ++round) {
        const LodScene scene(random);
        CAPTURE(round);
        CHECK(wrongly_covered(scene) == 0);
        int far_apart = 0;
        // Quarters of the finest level that touch the raster.
        const std::int64_t quarter = scene.grid.quads() / 2;
        for (std::int64_t y = 0; y < scene.grid.height() - 1; y += quarter)
            for (std::int64_t x = 0; x < scene.grid.width() - 1; x += quarter) {
                const auto at =
                    shaders::entry_of(scene.lod, scene.view, {static_cast<int>(x), static_cast<int>(y)});
                CHECK((at.block >= 0) == scene.has_ground(x, y));
                if (at.block < 0) continue;
                const int c = scene.blocks.blocks()[static_cast<std::size_t>(at.block)].coarseness;
                for (int i = 0; i < 9; ++i) {
                    const glm::ivec2 beside(static_cast<int>(x + (i % 3 - 1) * quarter),
                                            static_cast<int>(y + (i / 3 - 1) * quarter));
                    const auto other = shaders::entry_of(scene.lod, scene.view, beside);
                    if (other.block < 0) continue;
                    const int d = scene.blocks.blocks()[static_cast<std::size_t>(other.block)].coarseness;
                    far_apart += std::abs(c - d) > 1;
                }
            }
        CHECK(far_apart == 0);
    }
}

// The same by plain splitting, one cell after another, until nothing is wrong.
TEST_CASE(
    "levels are as fine as asked for, neighbours within one, and nothing is finer than these two need") {
    Random random(2);
    int forced = 0;
    for (int round = 0; round < 60; ++round) {
        const LodScene scene(random);
        CAPTURE(round);
        struct Cell {
            int block, level;
            glm::ivec2 place;  // first entry
        };
        // Entry -> level, by block; split wherever a neighbour's is two finer.
        std::vector<int> levels = scene.asked_levels();
        const auto level_of = [&](const glm::ivec2& sample) -> int* {
            const auto at = shaders::entry_of(scene.lod, scene.view, sample);
            if (at.block < 0) return nullptr;
            return &levels[static_cast<std::size_t>(at.block * shaders::kQuadtreeEntries +
                                                    shaders::entry_at(at.place))];
        };
        const std::vector<int> asked = levels;
        const int step = 1 << scene.view.eye_cell.w;  // of the finest entries
        // Cells reach over the raster's far borders.
        const glm::ivec2 size =
            static_cast<int>(scene.grid.extent(0)) * glm::ivec2(scene.grid.nodes_x(0), scene.grid.nodes_y(0));
        for (bool changed = true; changed;) {
            changed = false;
            for (int y = 0; y < size.y; y += step)
                for (int x = 0; x < size.x; x += step) {
                    int* mine = level_of({x, y});
                    if (!mine) continue;
                    for (int i = 0; i < 9; ++i) {
                        const int* other = level_of({x + (i % 3 - 1) * step, y + (i / 3 - 1) * step});
                        if (!other || *mine <= *other + 1) continue;
                        // Split the cell about it once.
                        const int level = *mine, shift = level + scene.view.eye_cell.w;
                        const glm::ivec2 first((x >> shift) << shift, (y >> shift) << shift);
                        for (int v = 0; v < 1 << shift; v += step)
                            for (int u = 0; u < 1 << shift; u += step)
                                if (int* part = level_of(first + glm::ivec2(u, v))) *part = level - 1;
                        changed = true;
                        break;
                    }
                }
        }
        int wrong = 0;
        for (int y = 0; y < size.y; y += step)
            for (int x = 0; x < size.x; x += step)
                if (const int* level = level_of({x, y})) wrong += scene.level_at({x, y}) != *level;
        REQUIRE(wrong == 0);
        for (std::size_t i = 0; i < levels.size(); ++i) forced += asked[i] != levels[i];
    }
    CHECK(forced > 1000);
}

TEST_CASE("a cell that was divided for its neighbours' sake keeps its look, as far as two levels") {
    Random random(5);
    int kept = 0, kept_farther = 0;
    for (int round = 0; round < 60; ++round) {
        LodScene scene(random);
        if (round % 2 == 1) scene.fade(random);
        scene.lod.run(scene.view, scene.blocks, scene.shapes);
        const int most_levels = scene.view.eye_cell.w > 2 ? 2 : 1;
        const auto blocks = scene.blocks.blocks();
        for (std::size_t b = 0; b < blocks.size(); ++b) {
            const AskedBlock asked(scene.lod, scene.view, blocks[b]);
            for (int e = 0; e < shaders::kQuadtreeEntries; ++e) {
                const glm::ivec2 place = shaders::entry_place(e);
                if (!shaders::has_entry(blocks[b], place)) continue;
                const int i = static_cast<int>(b) * shaders::kQuadtreeEntries + e;
                const int level = scene.lod.level(i), lod = asked.cell(place).lod;
                REQUIRE(level * shaders::kLodSteps <= lod);
                REQUIRE(scene.lod.lod(i) == std::min(lod, (level + most_levels) * shaders::kLodSteps));
                if (level == shaders::asked_level(scene.view, blocks[b], asked.cell(place))) continue;
                ++kept;
                kept_farther += scene.lod.lod(i) > (level + 1) * shaders::kLodSteps;
            }
        }
    }
    MESSAGE(kept, " entries of divided cells, ", kept_farther, " turned by more than a level");
    CHECK(kept_farther > 1000);
}

namespace {

// A scene whose entries are as coarse as one likes.
struct AnyLods {
    const LodScene& scene;
    std::vector<int> lods;

    const shaders::QuadtreeBlock& block(int i) const { return scene.lod.block(i); }
    const shaders::QuadtreePlace& place(std::uint32_t i) const { return scene.lod.place(i); }
    int lod(int i) const { return lods[static_cast<std::size_t>(i)]; }
};

}  // namespace

// Where chunks draw the rest of the ground, neighbours are as coarse as they are, however fine the cell is.
TEST_CASE("a cell knows of its border what touches it there, up to fifteen levels coarser") {
    Random random(6);
    std::int64_t compared = 0, far_coarser = 0;
    for (int round = 0; round < 40; ++round) {
        const LodScene scene(random);
        const int quads = 1 << scene.view.eye_cell.w;
        AnyLods about{scene, std::vector<int>(scene.lod.lods().size())};
        for (const auto& cell : scene.lod.instances()) {
            for (int& lod : about.lods) lod = whole(random, 0, (cell.level + 15) * shaders::kLodSteps);
            const int own = cell.level * shaders::kLodSteps + whole(random, 0, 2 * shaders::kLodSteps);
            const auto made = shaders::instance_of(about, scene.view, cell.corner, cell.level, own);
            const auto beside = [&](int i) {
                const glm::ivec2 at = cell.corner + shaders::sample_about(i, quads << cell.level);
                return std::max(own, shaders::lod_at(about, scene.view, at, cell.level));
            };
            // Clockwise, from the north-western corner on.
            for (int side = 0; side < 4; ++side)
                for (int along = 0; along < quads; ++along) {
                    const glm::ivec2 at =
                        std::array<glm::ivec2, 4>{{{along, 0},
                                                   {quads, along},
                                                   {quads - along, quads},
                                                   {0, quads - along}}}[static_cast<std::size_t>(side)];
                    const int first = beside(3 * side + 1), last = beside(3 * side + 2);
                    const int corner = std::max({beside(3 * side), first, beside((3 * side + 11) % 12)});
                    const int expected = along == 0           ? corner
                                         : 2 * along < quads  ? first
                                         : 2 * along == quads ? std::max(first, last)
                                                              : last;
                    REQUIRE(shaders::border_lod(made, at, quads) == expected);
                    // And stays on its side, between its corners.
                    const auto vertex = shaders::quadtree_vertex(made, at, quads);
                    const glm::ivec2 stands = (vertex.cell - cell.corner) >> cell.level;
                    REQUIRE((side % 2 == 0 ? stands.y == at.y : stands.x == at.x));
                    REQUIRE(glm::all(glm::lessThanEqual(stands, at)));
                    REQUIRE(glm::all(glm::greaterThanEqual(stands, glm::ivec2(0))));
                    ++compared;
                    far_coarser += expected - own > 8 * shaders::kLodSteps;
                }
            if (compared > 4000 * (round + 1)) break;
        }
    }
    CHECK(far_coarser > 1000);
}

TEST_CASE(
    "all cells together are one surface: every edge inside has a triangle on either side, and none turns "
    "over") {
    Random random(3);
    std::int64_t snapped = 0;
    for (int round = 0; round < 40; ++round) {
        LodScene scene(random);
        if (round % 2 == 1) scene.fade(random);
        scene.lod.run(scene.view, scene.blocks, scene.shapes);
        CAPTURE(round);
        std::map<std::pair<Corner, Corner>, int> edges;
        std::map<Corner, std::pair<int, float>> surfaces;
        std::int64_t area = 0, drawn = 0;
        for (const Triangle& triangle : triangles_of(scene)) {
            REQUIRE(triangle.twice_area() >= 0);
            if (triangle.twice_area() == 0) {
                ++snapped;
                continue;
            }
            area += triangle.twice_area();
            for (std::size_t c = 0; c < 3; ++c) {
                const auto& a = triangle.corner[c];
                const auto& b = triangle.corner[(c + 1) % 3];
                ++edges[{{a.cell.x, a.cell.y}, {b.cell.x, b.cell.y}}];
                // Whoever draws a vertex draws it alike.
                const auto [at, is_new] = surfaces.insert({{a.cell.x, a.cell.y}, {a.level, a.turned}});
                REQUIRE((at->second == std::pair{a.level, a.turned}));
                REQUIRE((a.cell.x & ((1 << a.level) - 1)) + (a.cell.y & ((1 << a.level) - 1)) == 0);
            }
        }
        for (const auto& cell : scene.lod.instances()) {
            const std::int64_t side = std::int64_t{1} << (cell.level + scene.view.eye_cell.w);
            drawn += 2 * side * side;
        }
        REQUIRE(area == drawn);
        for (const auto& [edge, count] : edges) {
            REQUIRE(count == 1);
            if (edges.contains({edge.second, edge.first})) continue;
            // The border of what is drawn: outside of it there is no ground.
            const glm::ivec2 a(edge.first.first, edge.first.second), b(edge.second.first, edge.second.second);
            const glm::ivec2 along = glm::sign(b - a), right(-along.y, along.x);
            REQUIRE((along.x == 0 || along.y == 0));
            const glm::ivec2 middle = (a + b) / 2;
            // Just outside of it.
            const glm::ivec2 outside(middle.x - (right.x > 0   ? 0
                                                 : right.x < 0 ? 1
                                                               : 0),
                                     middle.y - (right.y > 0   ? 0
                                                 : right.y < 0 ? 1
                                                               : 0));
            REQUIRE(scene.level_at(outside) == -1);
        }
    }
    CHECK(snapped > 1000);
}

TEST_CASE(
    "a tile's shape: a cell's error is what its samples lie beside triangles between filtered corners") {
    Random random(4);
    for (const auto& size : {std::pair{32, 0}, {64, 0}, {64, 1}, {32, 2}, {64, 3}, {128, 9}}) {
        const int quads = size.first, level = size.second;
        const int side = pager::heights_texels_side(quads);
        std::vector<std::int32_t> texels(static_cast<std::size_t>(side * side));
        const int roughness = 1 << whole(random, 0, 16);
        for (auto& texel : texels) texel = 2 * whole(random, -roughness, roughness) + whole(random, 0, 1);
        const auto shape = quadtree_shape(std::as_bytes(std::span(texels)), {quads, level, 0, -1});
        const auto height = [&](int x, int y) {
            const int cx = std::clamp(x, -3, quads + 3), cy = std::clamp(y, -3, quads + 3);
            return static_cast<double>(texels[static_cast<std::size_t>((cy + 3) * side + cx + 3)] >> 1);
        };
        // As the coarsest tile that there is has it, where the level is coarser still.
        const int coarsest = 1 << std::min(level, 10);
        const auto filtered = [&](int x, int y, int level_spacing) {
            if (level == 0) return height(x, y);
            const int spacing = std::min(level_spacing, coarsest);
            double sum = 0.0;
            for (const int east : {-1, 0, 1})
                for (const int south : {-1, 0, 1})
                    sum += (east == 0 ? 0.5 : 0.25) * (south == 0 ? 0.5 : 0.25) *
                           height(x + east * spacing, y + south * spacing);
            return sum;
        };
        for (int depth = 0; depth < shaders::kQuadtreeDepth; ++depth) {
            const int spacing = 8 >> depth, cells = 1 << depth, cell = quads / cells;
            for (int i = 0; i < cells * cells; ++i) {
                double most = 0.0;
                for (int y = i / cells * cell; y <= (i / cells + 1) * cell; ++y)
                    for (int x = i % cells * cell; x <= (i % cells + 1) * cell; ++x) {
                        const int cx = std::min(x / spacing, quads / spacing - 1),
                                  cy = std::min(y / spacing, quads / spacing - 1);
                        const double u = 1.0 * x / spacing - cx, v = 1.0 * y / spacing - cy;
                        const auto corner = [&](int east, int south) {
                            return filtered((cx + east) * spacing, (cy + south) * spacing, spacing);
                        };
                        const double nw = corner(0, 0), ne = corner(1, 0), sw = corner(0, 1),
                                     se = corner(1, 1);
                        double on = 0.0;
                        if ((cx + cy) % 2 == 0)
                            on = u >= v ? nw + (ne - nw) * u + (se - ne) * v
                                        : nw + (sw - nw) * v + (se - sw) * u;
                        else
                            on = u + v <= 1 ? nw + (ne - nw) * u + (sw - nw) * v
                                            : se + (sw - se) * (1 - u) + (ne - se) * (1 - v);
                        most = std::max(most, std::abs(height(x, y) - on));
                    }
                const int error = shape.error[shaders::shape_first(depth) + i];
                // Corners are rounded down, errors up.
                CHECK(error >= most - 1.0);
                // But for what finer cells within miss by more.
                if (depth == shaders::kQuadtreeDepth - 1) CHECK(error <= most + 2.0);
            }
        }
    }
}
