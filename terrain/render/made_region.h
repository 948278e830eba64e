// Where the mesh gives way to made ground: nodes of the source's finest level that the quadtree's cells draw instead
// of their chunks, and what holds both together.
//
// A node changes hands when it is so near that ground may be made of it, its tile and those that its border reads are
// there and turned, and no chunk coarser than its own lies beside it: whether ground has been made of it or not, or what
// a ridge hid would change hands when it is seen, however near. Its cells then have the source's samples at most (the
// lattice on which its neighbours' borders lie), and stand along a chunk's border where that has vertices; the chunk
// does not morph there. Both compute positions from the same integers, so they meet bit by bit. docs/detail.md.
//
// Of one frame; render thread. Keeps its memory from frame to frame.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>
#include "ridgeline/io/grid.h"
#include "ridgeline/io/node_record.h"
#include "ridgeline/pager/pager.h"
#include "ridgeline/select/finest_nodes.h"
#include "ridgeline/select/selection.h"
#include "ridgeline/shaders/shared/quadtree_blocks.h"

namespace ridgeline::render {

class HeightTexture;

// Which places along a node's sides a vertex may take: a bit a sample of the source, none where no chunk is beyond.
using NodeSeams = std::array<std::array<std::uint32_t, shaders::kSeamWords>, io::kSides>;

class MadeRegion {
  public:
    struct Node {
        io::NodeId id;
        NodeSeams seams{};
    };

    // records: as in Store::records(), which outlive it.
    MadeRegion(const io::Grid& source, std::span<const io::NodeRecord> records)
        : grid_(source), records_(records) {}

    // Of a frame whose heights have been turned to its eye. near: nodes of the source's finest level.
    void find(std::span<const select::DrawEntry> draws, std::span<const select::NearNode> near,
              const HeightTexture& heights, const pager::Pager& pager);

    // In the grid's order.
    std::span<const Node> nodes() const { return nodes_; }
    // Of all of them: the source's finest.
    int level() const { return grid_.finest(); }
    // Null where chunks draw. A node of the source's finest level.
    const Node* node(io::NodeId id) const;
    // Whether a tile is one of the region's nodes, or above or below one.
    bool concerns(io::NodeId tile) const;
    bool concerns_place(const glm::dvec2& source_place) const;

    // The entry as it is drawn beside the region: without morphs where they meet.
    select::DrawEntry beside(const select::DrawEntry& entry) const;

  private:
    using Draws = std::span<const select::DrawEntry>;
    bool may_change_hands(io::NodeId id, const HeightTexture& heights, const pager::Pager& pager) const;
    bool has_turned(io::NodeId id, const HeightTexture& heights, const pager::Pager& pager) const;
    bool meets_coarser(io::NodeId id) const;
    const select::DrawEntry* drawn(io::NodeId id) const;
    void find_above();
    void find_seams(Node& node, const pager::Pager& pager) const;

    io::Grid grid_;
    std::span<const io::NodeRecord> records_;
    // Of the frame, by linear place.
    struct Drawn {
        select::NodeIndex index = 0;
        const select::DrawEntry* entry = nullptr;
    };
    std::vector<Drawn> drawn_;
    std::vector<Node> nodes_;
    std::vector<std::int64_t> above_;  // linear places of what lies above them, sorted
};

}  // namespace ridgeline::render
