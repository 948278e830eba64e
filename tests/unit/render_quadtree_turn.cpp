// How the quadtree's cells turn into each other: what a place looks like does not jump when the eye comes near
// enough for a cell to divide, and a cell about to become its parent has its surface.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "ridgeline/render/quadtree_patch.h"
#include "ridgeline/shaders/lib/disc.h"
#include "ridgeline/shaders/lib/quadtree_vertex.h"
#include "unit/render_quadtree_scene.h"

using namespace ridgeline;
using namespace ridgeline::render;
using namespace ridgeline::test;

namespace {

// An entry, and how it is seen from places on a line.
struct Watched {
    const shaders::QuadtreeBlock& block;
    const shaders::QuadtreeShape& shape;
    glm::ivec2 place;

    int level(const shaders::QuadtreeUniforms& view) const {
        return shaders::asked_level(view, block, shape, place);
    }
    int lod(const shaders::QuadtreeUniforms& view) const {
        return shaders::lod_of(view, block, shape, place, level(view));
    }
};

Watched random_entry(const LodScene& scene, Random& random) {
    const auto blocks = scene.blocks.blocks();
    for (;;) {
        const auto& block = blocks[static_cast<std::size_t>(whole(random, 0, static_cast<int>(blocks.size()) - 1))];
        const glm::ivec2 place = shaders::entry_place(whole(random, 0, shaders::kQuadtreeEntries - 1));
        if (shaders::has_own_tile(block) && shaders::has_entry(block, place))
            return {block, scene.shapes[shaders::block_slot(block)], place};
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
        const LodScene scene(random);
        for (int line = 0; line < 400; ++line) {
            const Watched watched = random_entry(scene, random);
            const auto on_line = [from = glm::dvec3(whole(random, -2000, 4000), whole(random, -2000, 4000), whole(random, -500, 3000)),
                                  to = glm::dvec3(shaders::entry_corner(scene.view, watched.block, watched.place), 0)](double share) {
                return glm::mix(from, to, share);
            };
            const auto level = [&](double share) { return watched.level(seen_from(scene.view, on_line(share))); };
            const auto lod = [&](double share) { return watched.lod(seen_from(scene.view, on_line(share))); };
            // Nearer is finer, in whole steps; each is looked for.
            double away = 0.0, near = 1.0;
            if (level(away) == level(near)) continue;
            const int wanted = whole(random, level(near), level(away) - 1);
            for (int i = 0; i < 60; ++i) {
                const double middle = 0.5 * (away + near);
                (level(middle) > wanted ? away : near) = middle;
            }
            ++switches;
            farthest = std::max(farthest, static_cast<double>(std::abs(lod(away) - lod(near))));
        }
    }
    MESSAGE(switches, " switches, the farthest of ", farthest, " steps");
    CHECK(switches > 5000);
    CHECK(farthest <= 2.0);
}
