// The quadtree of the quadtree surface on the CPU: levels, balance and drawn cells by the same functions as
// the GPU's passes. The baseline (--lod cpu), and what the passes are held against.
//
// The passes' own algorithm, one entry after another: every entry in every pass of balancing, as the GPU has it, not
// only those that changed. One thread at a time; after the first frames nothing allocates.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ridgeline/render/quadtree_blocks.h"
#include "ridgeline/shaders/lib/quadtree_shape.h"
#include "ridgeline/shaders/shared/quadtree_blocks.h"

namespace ridgeline::render {

// Of a tile's texels (io/pager/heights_texels.h).
shaders::QuadtreeShape quadtree_shape(std::span<const std::byte> texels, const shaders::ShapeTile& tile);

// Passes over all blocks after which levels are balanced, at most: what an entry asks for goes an entry
// farther in each, and loses a level.
constexpr int most_balance_passes(int coarsest) { return 2 * (coarsest + shaders::kQuadtreeDepth + 1); }

class QuadtreeLod {
  public:
    // blocks, shapes (by slot): until the next run.
    void run(const shaders::QuadtreeUniforms& view, const QuadtreeBlocks& blocks,
             std::span<const shaders::QuadtreeShape> shapes);

    // The level matrix: by block, entry by entry, row by row. Entries that the block does not draw say
    // nothing.
    std::span<const int> levels() const { return levels_; }
    std::span<const int> lods() const { return lods_; }
    std::span<const shaders::QuadtreeInstance> instances() const { return instances_; }

    // As shaders/lib/quadtree.h, quadtree_levels.h and quadtree_balance.h ask for them.
    const shaders::QuadtreeBlock& block(int i) const { return blocks_[static_cast<std::size_t>(i)]; }
    const shaders::QuadtreePlace& place(std::uint32_t i) const { return places_[i]; }
    int level(int i) const { return levels_[static_cast<std::size_t>(i)]; }
    int lod(int i) const { return lods_[static_cast<std::size_t>(i)]; }
    const shaders::QuadtreeShape& shape(std::uint32_t slot) const { return shapes_[slot]; }
    bool lower(int entry, int level);

  private:
    void ask(const shaders::QuadtreeUniforms& view);
    bool balance(const shaders::QuadtreeUniforms& view);
    void turn(const shaders::QuadtreeUniforms& view);
    void emit(const shaders::QuadtreeUniforms& view);

    std::span<const shaders::QuadtreeBlock> blocks_;
    std::span<const shaders::QuadtreePlace> places_;
    std::span<const shaders::QuadtreeShape> shapes_;
    std::vector<int> levels_, lods_;
    std::vector<shaders::QuadtreeInstance> instances_;
};

}  // namespace ridgeline::render
