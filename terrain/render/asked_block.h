// What the entries of a block ask for, on the CPU: as the pass quadtree_levels.comp works it out, by the same functions.
//
// A value once it is made; nothing allocates.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <glm/glm.hpp>

#include "ridgeline/shaders/lib/quadtree_levels.h"

namespace ridgeline::render {

class AskedBlock {
  public:
    // quadtree: has blocks and shapes, as quadtree_levels.h asks for them.
    template <class Quadtree>
    AskedBlock(const Quadtree& quadtree, const shaders::QuadtreeUniforms& view,
               const shaders::QuadtreeBlock& block) {
        ask(quadtree, view, block);
    }

    const shaders::AskedCell& cell(const glm::ivec2& place) const { return cells_[number(place)]; }

    // As quadtree_levels.h asks for it.
    int least_lod(int cell) const { return least_lods_[static_cast<std::size_t>(cell)]; }

  private:
    static std::size_t number(const glm::ivec2& place) {
        return static_cast<std::size_t>(shaders::entry_at(place));
    }

    template <class Quadtree>
    void ask(const Quadtree& quadtree, const shaders::QuadtreeUniforms& view,
             const shaders::QuadtreeBlock& block) {
        const int share = shaders::like_above(block);
        std::array<int, shaders::kQuadtreeEntries> wanted{};
        if (share > 0) {
            const shaders::QuadtreeBlock& above = quadtree.block(block.above);
            ask(quadtree, view, above);
            for_each_place([&](const glm::ivec2& place) {
                wanted[number(place)] = cell(shaders::place_above(block, place, above.coarseness)).lod;
            });
        }
        least_lods_.fill((shaders::kQuadtreeAnyLevel + 1) * shaders::kLodSteps);
        for_each_place([&](const glm::ivec2& place) {
            const int own = share < shaders::kTurnSteps ? shaders::own_lod(quadtree, view, block, place) : 0;
            int& lod = wanted[number(place)];
            lod = shaders::wanted_lod(block, own, lod);
            for (int depth = 0; depth < shaders::kQuadtreeDepth; ++depth) {
                int& least = least_lods_[static_cast<std::size_t>(shaders::shape_index(place, depth))];
                least = std::min(least, lod);
            }
        });
        for_each_place([&](const glm::ivec2& place) {
            cells_[number(place)] = shaders::asked_cell(*this, block, place, wanted[number(place)]);
        });
    }

    template <class Visit>
    static void for_each_place(Visit visit) {
        for (int entry = 0; entry < shaders::kQuadtreeEntries; ++entry) visit(shaders::entry_place(entry));
    }

    std::array<int, shaders::kShapeErrors> least_lods_{};
    std::array<shaders::AskedCell, shaders::kQuadtreeEntries> cells_{};
};

}  // namespace ridgeline::render
