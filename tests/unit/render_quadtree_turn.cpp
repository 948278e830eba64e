// How the quadtree's cells turn into each other: what a place looks like does not jump when the eye comes near
// enough for a cell to divide, and a cell about to become its parent has its surface.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "ridgeline/render/quadtree_patch.h"
#include "ridgeline/shaders/lib/disc.h"
#include "ridgeline/shaders/lib/quadtree_vertex.h"
#include "unit/render_quadtree_scene.h"
#include "unit/whole_heights.h"

using namespace ridgeline;
using namespace ridgeline::render;
using namespace ridgeline::test;

namespace {

// What an entry asks for.
struct Asked {
    int level = -1, lod = -1;
};

// An entry, and how it is seen from places on a line.
struct Watched {
    const QuadtreeLod& lods;
    const shaders::QuadtreeBlock& block;
    glm::ivec2 place;

    Asked from(const shaders::QuadtreeUniforms& view) const {
        const shaders::AskedCell cell = AskedBlock(lods, view, block).cell(place);
        return {shaders::asked_level(view, block, cell), cell.lod};
    }
};

Watched random_entry(const LodScene& scene, Random& random) {
    const auto blocks = scene.blocks.blocks();
    for (;;) {
        const auto& block =
            blocks[static_cast<std::size_t>(whole(random, 0, static_cast<int>(blocks.size()) - 1))];
        const glm::ivec2 place = shaders::entry_place(whole(random, 0, shaders::kQuadtreeEntries - 1));
        if (shaders::has_entry(block, place)) return {scene.lod, block, place};
    }
}

// samples, samples, quanta.
shaders::QuadtreeUniforms seen_from(shaders::QuadtreeUniforms view, const glm::dvec3& eye) {
    const glm::dvec3 cell = glm::floor(eye);
    view.eye_cell = {glm::ivec3(cell), view.eye_cell.w};
    view.eye_rest = {glm::vec3(eye - cell), view.eye_rest.w};
    return view;
}

}  // namespace

TEST_CASE("What a place is drawn with does not jump where the eye comes near enough for a cell to divide") {
    Random random(11);
    int switches = 0;
    double farthest = 0.0;
    for (int round = 0; round < 40; ++round) {
        LodScene scene(random);
        if (round % 2 == 1) scene.fade(random);
        for (int line = 0; line < 250; ++line) {
            const Watched watched = random_entry(scene, random);
            const auto on_line =
                [from = glm::dvec3(whole(random, -2000, 4000), whole(random, -2000, 4000),
                                   whole(random, -500, 3000)),
                 to = glm::dvec3(shaders::entry_corner(scene.view, watched.block, watched.place), 0)](
                    double share) { return glm::mix(from, to, share); };
            const auto asked = [&](double share) {
                return watched.from(seen_from(scene.view, on_line(share)));
            };
            // Nearer is finer, in whole steps; each is looked for.
            double away = 0.0, near = 1.0;
            const int coarse = asked(away).level, fine = asked(near).level;
            if (coarse == fine) continue;
            const int wanted = whole(random, fine, coarse - 1);
            for (int i = 0; i < 60; ++i) {
                const double middle = 0.5 * (away + near);
                (asked(middle).level > wanted ? away : near) = middle;
            }
            ++switches;
            farthest = std::max(farthest, static_cast<double>(std::abs(asked(away).lod - asked(near).lod)));
        }
    }
    MESSAGE(switches, " switches, the farthest of ", farthest, " steps");
    CHECK(switches > 3000);
    CHECK(farthest <= 2.0);
}

namespace {

shaders::QuadtreeEntry entry_at(const LodScene& scene, const glm::ivec2& sample) {
    return shaders::entry_of(scene.lod, scene.view, sample);
}
// At a finest sample.
Asked asked_at(const LodScene& scene, const glm::ivec2& sample) {
    const auto entry = entry_at(scene, sample);
    if (entry.block < 0) return {};
    const auto& block = scene.blocks.blocks()[static_cast<std::size_t>(entry.block)];
    return Watched{scene.lod, block, entry.place}.from(scene.view);
}

// Those of the finest level that has any are gone.
LodScene without_finest(const LodScene& scene) {
    LodScene rest = scene;
    const int finest =
        std::ranges::max(scene.tiles, {}, [](const auto& tile) { return tile.node.level; }).node.level;
    std::erase_if(rest.tiles,
                  [&](const SlottedTile& tile) { return tile.node.level == finest && finest > 0; });
    rest.build();
    rest.view.blocks.x = rest.blocks.place_bits();
    rest.lod.run(rest.view, rest.blocks, rest.shapes);
    return rest;
}

}  // namespace

TEST_CASE("Tiles that come are drawn like those above them at first") {
    Random random(13);
    std::int64_t compared = 0, as_before = 0;
    for (int round = 0; round < 60; ++round) {
        LodScene scene(random);
        const LodScene before = without_finest(scene);
        const int finest = scene.tiles.back().node.level;
        for (const SlottedTile& tile : scene.tiles)
            scene.fades[tile.slot] = tile.node.level == finest ? 1.0f : 0.0f;
        scene.blocks.fade(scene.fades);
        for (int i = 0; i < 300; ++i) {
            const glm::ivec2 sample(whole(random, 0, static_cast<int>(scene.grid.width()) - 1),
                                    whole(random, 0, static_cast<int>(scene.grid.height()) - 1));
            const Asked without = asked_at(before, sample);
            if (without.level < 0) continue;
            const Asked at_first = asked_at(scene, sample);
            const auto& block =
                scene.blocks.blocks()[static_cast<std::size_t>(entry_at(scene, sample).block)];
            const int coarsest = block.coarseness + shaders::kQuadtreeDepth - shaders::least_depth(block);
            ++compared;
            // Blocks are smaller than cells may be: these are then their parents' parts.
            as_before += without.level <= coarsest;
            REQUIRE(at_first.level == std::min(without.level, coarsest));
            REQUIRE(at_first.lod == without.lod);
        }
    }
    MESSAGE(compared, " places, ", as_before, " with the same cells");
    CHECK(as_before > 1000);
}

namespace {

std::array<int, shaders::kQuadtreeEntries> asked_lods(const LodScene& scene,
                                                      const shaders::QuadtreeBlock& block) {
    const AskedBlock asked(scene.lod, scene.view, block);
    std::array<int, shaders::kQuadtreeEntries> lods{};
    for (int e = 0; e < shaders::kQuadtreeEntries; ++e)
        lods[static_cast<std::size_t>(e)] = asked.cell(shaders::entry_place(e)).lod;
    return lods;
}

// How far what the tile asks for lies from what the blocks above draw, at most, with what those turn by themselves.
int most_to_turn(const LodScene& scene, const shaders::QuadtreeBlock& block) {
    if (shaders::like_above(block) == 0) return 0;
    const shaders::QuadtreeBlock& above = scene.lod.block(block.above);
    int most = 0;
    if (shaders::has_own_tile(block)) {
        const AskedBlock asked(scene.lod, scene.view, above);
        for (int e = 0; e < shaders::kQuadtreeEntries; ++e) {
            const glm::ivec2 place = shaders::entry_place(e);
            const int own = shaders::own_lod(scene.lod, scene.view, block, place);
            const int over = asked.cell(shaders::place_above(block, place, above.coarseness)).lod;
            most = std::max(most, std::abs(own - over));
        }
    }
    return most + most_to_turn(scene, above);
}

}  // namespace

// The finest level's tiles, or all of the two finest.
TEST_CASE(
    "While tiles turn lods change by no more than their share of the time, however much the tiles know") {
    Random random(14);
    constexpr int kSteps = 16;
    int divided = 0, farthest = 0;
    for (int round = 0; round < 240; ++round) {
        LodScene scene(random);
        const int turning = scene.tiles.back().node.level - round % 2;
        const auto turn = [&](float fade) {
            for (const SlottedTile& tile : scene.tiles)
                scene.fades[tile.slot] = tile.node.level >= turning ? fade : 0.0f;
            scene.blocks.fade(scene.fades);
        };
        const auto blocks = scene.blocks.blocks();
        for (int i = 0; i < 8; ++i) {
            const auto& block =
                blocks[static_cast<std::size_t>(whole(random, 0, static_cast<int>(blocks.size()) - 1))];
            turn(1.0f);
            auto before = asked_lods(scene, block);
            for (int step = kSteps - 1; step >= 0; --step) {
                const int to_turn_before = most_to_turn(scene, block);
                turn(static_cast<float>(step) / kSteps);
                const auto lods = asked_lods(scene, block);
                const int to_turn = std::max(to_turn_before, most_to_turn(scene, block));
                for (std::size_t e = 0; e < lods.size(); ++e) {
                    const int changed = std::abs(lods[e] - before[e]);
                    divided += lods[e] / shaders::kLodSteps < before[e] / shaders::kLodSteps;
                    farthest = std::max(farthest, changed);
                    // What rounding takes besides, of each tile.
                    REQUIRE(changed <= to_turn / kSteps + 2);
                }
                before = lods;
            }
        }
    }
    MESSAGE(divided, " divisions; ", farthest, " of a level's ", shaders::kLodSteps,
            " steps in a 16th of the time at most");
    CHECK(divided > 1000);
    CHECK(farthest > 8);
}

namespace {

// A cell about whose borders all are alike; each corner as coarse as the coarser of its sides.
struct Borders {
    std::array<int, 4> lod;  // west, north, east, south
};

shaders::QuadtreeInstance cell_within(const glm::ivec2& corner, int level, int lod, const Borders& borders) {
    // Clockwise from the northern side.
    std::array<shaders::uint, 4> side{};
    for (std::size_t i = 0; i < 4; ++i)
        side[i] =
            static_cast<shaders::uint>(std::max(lod, borders.lod[(i + 1) % 4]) - level * shaders::kLodSteps);
    shaders::QuadtreeInstance cell{};
    cell.corner = corner;
    cell.level = level;
    cell.lod = static_cast<shaders::uint>(lod);
    for (std::size_t i = 0; i < 4; ++i)
        cell.border[i] = std::max(side[i], side[(i + 3) % 4]) | side[i] << shaders::kBorderBits |
                         side[i] << 2 * shaders::kBorderBits;
    return cell;
}

// What is drawn of a cell: vertices with their heights.
struct DrawnCell {
    const WholeHeights& heights;
    const shaders::QuadtreeInstance& cell;
    int quads;

    shaders::QuadtreeVertex vertex(int number) const {
        return shaders::quadtree_vertex(cell, {number % (quads + 1), number / (quads + 1)}, quads);
    }
    double height(const shaders::QuadtreeVertex& vertex) const {
        const shaders::DiscUniforms disc = uniforms_at({4000.0, 4000.0}, 0.0f);
        return static_cast<double>(
            shaders::twice_turned_height(heights, disc, vertex.cell, vertex.level, vertex.turned, 0));
    }
    // Of the triangle about a place; none outside of them all.
    std::optional<double> height_at(const glm::ivec2& place) const {
        const auto patch = quadtree_patch(quads);
        for (std::size_t i = 0; i < patch.size(); i += 3) {
            const std::array corner{vertex(patch[i]), vertex(patch[i + 1]), vertex(patch[i + 2])};
            std::array<double, 3> weight{};
            double area = 0.0;
            for (std::size_t c = 0; c < 3; ++c) {
                const glm::dvec2 a(corner[(c + 1) % 3].cell - place), b(corner[(c + 2) % 3].cell - place);
                weight[c] = a.y * b.x - a.x * b.y;
                area += weight[c];
            }
            if (area <= 0.0 || *std::ranges::min_element(weight) < 0.0) continue;
            double sum = 0.0;
            for (std::size_t c = 0; c < 3; ++c) sum += weight[c] * height(corner[c]);
            return sum / area;
        }
        return {};
    }
};

}  // namespace

TEST_CASE(
    "A cell that has turned into its parent, or farther, has its surface, but beside borders that have "
    "turned farther "
    "still") {
    Random random(12);
    const WholeHeights heights{rough};
    int compared = 0, beside = 0, off = 0;
    for (int round = 0; round < 300; ++round) {
        const int quads = 4 << whole(random, 0, 2);
        const int level = whole(random, 0, 4);
        const int farther =
            quads > 4 ? std::max(whole(random, -shaders::kLodSteps, shaders::kLodSteps), 0) : 0;
        const int lod = (level + 1) * shaders::kLodSteps + farther;
        const bool alike = round % 2 == 0;
        Borders about{};
        for (int& border : about.lod) border = alike ? lod : lod + whole(random, 0, shaders::kLodSteps);
        const int side = quads << level;
        const glm::ivec2 corner =
            2 * side * glm::ivec2(whole(random, 1, 4000 / side), whole(random, 1, 4000 / side));
        const auto whole_cell = cell_within(corner, level + 1, lod, about);
        const DrawnCell parent{heights, whole_cell, quads};
        for (int q = 0; q < 4; ++q) {
            const bool east = (q & 1) != 0, south = (q & 2) != 0;
            const Borders borders{{east ? lod : about.lod[0], south ? lod : about.lod[1],
                                   east ? about.lod[2] : lod, south ? about.lod[3] : lod}};
            const auto part_cell = cell_within(corner + side * glm::ivec2(east, south), level, lod, borders);
            const DrawnCell part{heights, part_cell, quads};
            for (int i = 0; i < (quads + 1) * (quads + 1); ++i) {
                const auto vertex = part.vertex(i);
                const auto there = parent.height_at(vertex.cell);
                REQUIRE(there.has_value());
                const glm::ivec2 in = vertex.cell - corner;
                const int rim = std::min({in.x, in.y, 2 * side - in.x, 2 * side - in.y}) >> level;
                const bool exempt = !alike && rim == 1;
                ++(exempt ? beside : compared);
                if (!exempt) off += std::abs(part.height(vertex) - *there) > 1e-3;
            }
        }
    }
    MESSAGE(compared, " vertices, and ", beside, " beside borders");
    CHECK(off == 0);
    CHECK(compared > 50000);
}
