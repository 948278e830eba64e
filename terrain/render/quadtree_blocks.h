// Which tile of heights draws which ground: the quadtree surface's blocks, and where they lie.
//
// The finest tile that is there draws a place. Blocks side by side must be no more than a level apart, so a
// tile about which tiles are missing gets neighbours that have none and draw the nearest ancestor's heights.
// A block draws those of its quarters that are no blocks themselves. Pure book-keeping, one thread at a time;
// after construction nothing allocates.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ridgeline/io/grid.h"
#include "ridgeline/render/made_region.h"
#include "ridgeline/shaders/shared/quadtree_blocks.h"

namespace ridgeline::render {

// A tile of heights on the GPU.
struct SlottedTile {
    io::NodeId node;
    std::uint32_t slot = 0;

    friend bool operator==(const SlottedTile&, const SlottedTile&) = default;
};

class QuadtreeBlocks {
  public:
    // most: tiles at a time.
    QuadtreeBlocks(const io::Grid& grid, std::size_t most);

    // tiles: each once, coarse before fine, none without its parent. Where they take more blocks than there
    // is room for, the finest are left out.
    // The same as the last time are not built again: a frame asks for the eye's lift, and once more to draw.
    void build(std::span<const SlottedTile> tiles);
    // fades, by slot: how much each tile still looks like the one above it. After every build().
    void fade(std::span<const float> fades);
    // Cells draw only the region's nodes and what is below them. After every build().
    void show_all();
    void show_only(const MadeRegion& region);
    // The region's seams by block, as quadtree_seam.h reads them, of those no finer than its nodes; until the next call.
    std::span<const NodeSeams> seams(const MadeRegion& region);

    std::span<const shaders::QuadtreeBlock> blocks() const { return blocks_; }
    std::size_t capacity() const { return capacity_; }
    // A power of two of them, more than half empty: quadtree.h, block_at.
    std::span<const shaders::QuadtreePlace> places() const { return places_; }
    int place_bits() const { return place_bits_; }

  private:
    static constexpr std::size_t kBlocksPerTile = 6;
    static constexpr std::size_t kFewBlocks = 1024;

    struct Node {
        io::NodeId id;
        std::uint32_t slot = 0;
        bool has_tile = false;
    };

    bool gather(std::span<const SlottedTile> tiles);
    bool add(const Node& node);
    bool add_about(io::NodeId parent);
    bool on_ground(io::NodeId node) const;
    std::size_t find(io::NodeId node) const;
    bool has(io::NodeId node) const { return places_[find(node)].block_and_coarseness != 0; }
    std::uint32_t own_quarters(io::NodeId node) const;
    int nearest_tile(io::NodeId node) const;
    void number();
    io::NodeId node_of(const shaders::QuadtreeBlock& block) const;

    io::Grid grid_;
    std::size_t capacity_;
    std::size_t limit_;  // of this build
    int place_bits_ = 0;
    std::array<std::vector<Node>, io::Grid::kMaxLevels> nodes_;  // by level
    std::size_t count_ = 0;
    std::vector<SlottedTile> built_;
    std::vector<NodeSeams> seams_;
    std::vector<shaders::QuadtreeBlock> blocks_;
    std::vector<shaders::QuadtreePlace> table_;
    std::span<shaders::QuadtreePlace> places_;  // the part of it that this build uses
};

}  // namespace ridgeline::render
