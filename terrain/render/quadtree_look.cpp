#include "ridgeline/render/quadtree_look.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "ridgeline/shaders/lib/disc.h"

namespace ridgeline::render {
namespace {

// The part of the shaders' source that the level asked for takes.
struct Source {
    QuadtreeSurface& quadtree;
    const HeightTexture& heights;
    const pager::Pager& pager;

    const shaders::QuadtreeBlock& block(int i) const {
        return quadtree.blocks().blocks()[static_cast<std::size_t>(i)];
    }
    const shaders::QuadtreePlace& place(std::uint32_t i) const { return quadtree.blocks().places()[i]; }
    const shaders::QuadtreeShape& shape(std::uint32_t slot) const {
        return quadtree.shape(slot, heights, pager);
    }
};

}  // namespace

double QuadtreeLook::height_m(const glm::dvec2& place) const {
    const shaders::QuadtreeUniforms& view = quadtree_.uniforms();
    const Source source{quadtree_, heights_, pager_};
    const auto entry = shaders::entry_of(source, view, glm::ivec2(glm::floor(place)));
    if (entry.block < 0) return disc_.height_m(place);
    const shaders::QuadtreeBlock& block = source.block(entry.block);
    if (!asked_ || asked_->block != entry.block)
        asked_ = AskedHere{entry.block, AskedBlock(source, view, block)};
    const shaders::AskedCell& cell = asked_->entries.cell(entry.place);
    const int asked = shaders::asked_level(view, block, cell);
    double highest_m = -std::numeric_limits<double>::infinity();
    for (int level = block.coarseness, before = -1; level <= asked; ++level) {
        const int lod = shaders::drawn_lod(view, block, cell.lod, level);
        if (lod == before) continue;
        before = lod;
        const int surface = lod / shaders::kLodSteps;
        const float turned = static_cast<float>(lod - surface * shaders::kLodSteps) / shaders::kLodSteps;
        for (const int drawn : {surface, surface + 1})
            highest_m = std::max(highest_m, triangle_m(place, drawn, turned));
    }
    return highest_m;
}

// Quads are divided as the cells' and the disc's are.
double QuadtreeLook::triangle_m(const glm::dvec2& place, int level, float turned) const {
    const double side = static_cast<double>(std::int64_t{1} << level);
    const glm::ivec2 quad(glm::floor(place / side));
    const glm::dvec2 past = place / side - glm::dvec2(quad);
    const auto height = [&](int east, int south) {
        const glm::ivec2 cell = (quad + glm::ivec2(east, south)) << level;
        return static_cast<double>(
            shaders::turned_height(disc_, heights_.uniforms(), cell, level, turned, eye_.quanta));
    };
    double quanta = 0.0;
    if (((quad.x ^ quad.y) & 1) == 0) {
        const double nw = height(0, 0), se = height(1, 1);
        quanta = past.x >= past.y ? nw + (height(1, 0) - nw) * (past.x - past.y) + (se - nw) * past.y
                                  : nw + (height(0, 1) - nw) * (past.y - past.x) + (se - nw) * past.x;
    } else {
        const double ne = height(1, 0), sw = height(0, 1);
        const double over = past.x + past.y - 1.0;
        const double corner = over <= 0.0 ? height(0, 0) : height(1, 1);
        quanta = over <= 0.0 ? corner * -over + ne * past.x + sw * past.y
                             : corner * over + ne * (1.0 - past.y) + sw * (1.0 - past.x);
    }
    return (quanta - static_cast<double>(eye_.quanta_rest)) * static_cast<double>(eye_.quantum_m);
}

}  // namespace ridgeline::render
