// Which tiles a pager knows: the nodes of the terrain's quadtree with their chunks and, behind them, those of
// the imagery's and the terrain's again with their heights alone, counted through, so that one table, one
// order of urgency and one memory serve all.
//
// Plain values; any thread.
#pragma once

#include <cstddef>
#include <cstdint>

#include "ridgeline/base/contract.h"
#include "ridgeline/io/grid.h"

namespace ridgeline::pager {

// A tile's place: for chunks the node's in the store's linear order (io::Grid::linear); imagery follows, then
// heights.
using NodeIndex = std::uint32_t;
constexpr NodeIndex kNoNode = 0xffffffffu;

enum class TileKind : std::uint8_t { chunk, imagery, heights };
constexpr std::size_t kTileKinds = 3;
constexpr TileKind kEveryTileKind[kTileKinds] = {TileKind::chunk, TileKind::imagery, TileKind::heights};
constexpr std::size_t index(TileKind kind) { return static_cast<std::size_t>(kind); }

class TileSpace {
  public:
    // A default-made grid has no nodes. All together must have fewer than 2^32 - 1.
    TileSpace(const io::Grid& chunks, const io::Grid& imagery = {}, const io::Grid& heights = {})
        : grids_{chunks, imagery, heights},
          imagery_begin_(static_cast<NodeIndex>(chunks.node_count())),
          heights_begin_(imagery_begin_ + static_cast<NodeIndex>(imagery.node_count())) {
        RIDGELINE_CHECK(fits(chunks, imagery, heights));
    }
    static bool fits(const io::Grid& chunks, const io::Grid& imagery, const io::Grid& heights = {}) {
        return chunks.node_count() + imagery.node_count() + heights.node_count() < std::int64_t{kNoNode};
    }

    const io::Grid& grid(TileKind kind) const { return grids_[pager::index(kind)]; }
    NodeIndex count() const { return heights_begin_ + static_cast<NodeIndex>(grids_[2].node_count()); }
    NodeIndex begin(TileKind kind) const {
        if (kind == TileKind::chunk) return 0;
        return kind == TileKind::imagery ? imagery_begin_ : heights_begin_;
    }
    NodeIndex root_count(TileKind kind) const {
        return grid(kind).levels() == 0 ? 0 : static_cast<NodeIndex>(grid(kind).first(1));
    }

    TileKind kind(NodeIndex tile) const {
        if (tile < imagery_begin_) return TileKind::chunk;
        return tile < heights_begin_ ? TileKind::imagery : TileKind::heights;
    }
    io::NodeId id(NodeIndex tile) const {
        const TileKind its = kind(tile);
        return grid(its).node_at(std::int64_t{tile} - begin(its));
    }
    NodeIndex index(TileKind kind, io::NodeId id) const {
        return begin(kind) + static_cast<NodeIndex>(grid(kind).linear(id));
    }

  private:
    io::Grid grids_[kTileKinds];
    NodeIndex imagery_begin_;
    NodeIndex heights_begin_;
};

}  // namespace ridgeline::pager
