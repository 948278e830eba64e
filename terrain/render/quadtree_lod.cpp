#include "ridgeline/render/quadtree_lod.h"

#include <algorithm>

#include "ridgeline/base/contract.h"
#include "ridgeline/pager/heights_texels.h"
#include "ridgeline/render/asked_block.h"
#include "ridgeline/shaders/lib/quadtree_balance.h"
#include "ridgeline/shaders/lib/quadtree_levels.h"
#include "ridgeline/shaders/lib/quadtree_shape.h"

namespace ridgeline::render {
namespace {

struct TileTexels {
    std::span<const std::byte> texels;
    int side;

    std::int32_t texel(const glm::ivec2& at) const {
        return pager::heights_texel(texels, static_cast<std::size_t>(at.y * side + at.x));
    }
};

// Calls visit(block, place) for every entry that its block draws; fine blocks first, as the GPU mostly does.
template <class Visit>
void for_each_entry(std::span<const shaders::QuadtreeBlock> blocks, Visit visit) {
    for (std::size_t i = blocks.size(); i-- > 0;)
        for (int entry = 0; entry < shaders::kQuadtreeEntries; ++entry)
            if (const glm::ivec2 place = shaders::entry_place(entry); shaders::has_entry(blocks[i], place))
                visit(static_cast<int>(i), place);
}

int number_of(int block, const glm::ivec2& place) {
    return block * shaders::kQuadtreeEntries + shaders::entry_at(place);
}

}  // namespace

shaders::QuadtreeShape quadtree_shape(std::span<const std::byte> bytes, const shaders::ShapeTile& tile) {
    const TileTexels texels{bytes, pager::heights_texels_side(tile.quads)};
    shaders::QuadtreeShape shape{};
    for (int entry = 0; entry < shaders::kQuadtreeEntries; ++entry) {
        const glm::ivec2 place = shaders::entry_place(entry);
        const shaders::EntryShape part = shaders::entry_shape(texels, tile, place);
        for (int depth = 0; depth < shaders::kQuadtreeDepth; ++depth) {
            int& error = shape.error[shaders::shape_index(place, depth)];
            error = std::max(error, part.error[depth]);
        }
        shape.least = entry == 0 ? part.least : std::min(shape.least, part.least);
        shape.most = entry == 0 ? part.most : std::max(shape.most, part.most);
    }
    return shape;
}

void QuadtreeLod::run(const shaders::QuadtreeUniforms& view, const QuadtreeBlocks& blocks,
                      std::span<const shaders::QuadtreeShape> shapes) {
    blocks_ = blocks.blocks();
    places_ = blocks.places();
    shapes_ = shapes;
    ask(view);
    int passes = 0;
    while (balance(view)) RIDGELINE_CHECK(++passes <= most_balance_passes(view.blocks.y));
    turn(view);
    emit(view);
}

void QuadtreeLod::ask(const shaders::QuadtreeUniforms& view) {
    levels_.assign(blocks_.size() * shaders::kQuadtreeEntries, 0);
    lods_.assign(levels_.size(), 0);
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
        const AskedBlock asked(*this, view, blocks_[i]);
        for (int entry = 0; entry < shaders::kQuadtreeEntries; ++entry) {
            const glm::ivec2 place = shaders::entry_place(entry);
            const shaders::AskedCell& cell = asked.cell(place);
            const auto at = static_cast<std::size_t>(number_of(static_cast<int>(i), place));
            if (shaders::has_entry(blocks_[i], place))
                levels_[at] = shaders::asked_level(view, blocks_[i], cell);
            lods_[at] = cell.lod;
        }
    }
}

bool QuadtreeLod::lower(int entry, int level) {
    int& held = levels_[static_cast<std::size_t>(entry)];
    if (level >= held) return false;
    held = level;
    return true;
}

bool QuadtreeLod::balance(const shaders::QuadtreeUniforms& view) {
    bool changed = false;
    for_each_entry(blocks_, [&](int block, const glm::ivec2& place) {
        if (shaders::balance_entry(*this, view, block, place)) changed = true;
    });
    return changed;
}

void QuadtreeLod::turn(const shaders::QuadtreeUniforms& view) {
    for_each_entry(blocks_, [&](int block, const glm::ivec2& place) {
        const int entry = number_of(block, place);
        int& lod = lods_[static_cast<std::size_t>(entry)];
        lod = shaders::drawn_lod(view, this->block(block), lod, level(entry));
    });
}

void QuadtreeLod::emit(const shaders::QuadtreeUniforms& view) {
    instances_.clear();
    for_each_entry(blocks_, [&](int block, const glm::ivec2& place) {
        if (shaders::draws_cell(*this, view, block, place))
            instances_.push_back(shaders::drawn_cell(*this, view, block, place));
    });
}

}  // namespace ridgeline::render
