// The nested lattice of a terrain: which nodes exist at which level, and where their samples lie.
//
// The finest level has the source's spacing; level l keeps every 2^(finest-l)-th sample, so a sample of a
// coarse level is a sample of every finer one. A node is `quads` lattice cells of its level a side; M x N
// root nodes, one in the shorter direction, cover the raster (tower paper). Lattice coordinates count finest
// samples: column eastwards, row southwards, (0,0) the north-western sample. Nodes that do not touch the
// raster do not exist.
#pragma once

#include <array>
#include <cstdint>

#include "ridgeline/io/node_id.h"

namespace ridgeline::io {

struct LatticePoint {
    std::int64_t x = 0;
    std::int64_t y = 0;
    friend constexpr bool operator==(const LatticePoint&, const LatticePoint&) = default;
};

class Grid {
  public:
    // Chunk vertices count samples in 24 bits, so a node is at most 2^23 samples a side.
    static constexpr int kMaxLevels = 18;
    // The longest side of a raster, in samples, that every tile size can hold.
    static constexpr std::int64_t kMaxSamples = std::int64_t{32} << (kMaxLevels - 1);

    Grid() = default;
    // width, height: samples, at least 2 each; quads: cells a node's side, a power of two from 32 to
    // 256.
    Grid(std::int64_t width, std::int64_t height, int quads);
    // The same ground with 2^octaves samples in each direction where this has one: the same nodes at the levels that this
    // has, and so many levels more.
    Grid finer(int octaves) const;

    std::int64_t width() const { return width_; }
    std::int64_t height() const { return height_; }
    int quads() const { return quads_; }
    int levels() const { return levels_; }
    int finest() const { return levels_ - 1; }

    // Finest samples between neighbouring samples of a level.
    std::int64_t step(int level) const { return std::int64_t{1} << (finest() - level); }
    // Finest samples along a node's side.
    std::int64_t extent(int level) const { return step(level) * quads_; }
    std::int32_t nodes_x(int level) const { return nodes_x_[static_cast<std::size_t>(level)]; }
    std::int32_t nodes_y(int level) const { return nodes_y_[static_cast<std::size_t>(level)]; }
    std::int64_t node_count() const { return first_[static_cast<std::size_t>(levels_)]; }

    bool contains(NodeId node) const {
        return node.level >= 0 && node.level < levels_ && node.x >= 0 && node.y >= 0 &&
               node.x < nodes_x(node.level) && node.y < nodes_y(node.level);
    }
    // Place in linear order: level by level, coarsest first, row by row.
    std::int64_t linear(NodeId node) const {
        return first_[static_cast<std::size_t>(node.level)] + std::int64_t{node.y} * nodes_x(node.level) +
               node.x;
    }
    NodeId node_at(std::int64_t linear) const;
    // The first place of a level; first(levels()) is node_count().
    std::int64_t first(int level) const { return first_[static_cast<std::size_t>(level)]; }

    // The north-western corner of a node.
    LatticePoint origin(NodeId node) const {
        return {node.x * extent(node.level), node.y * extent(node.level)};
    }

  private:
    void lay_out_nodes();

    std::int64_t width_ = 0, height_ = 0;
    int quads_ = 0, levels_ = 0;
    std::array<std::int32_t, kMaxLevels> nodes_x_{}, nodes_y_{};
    std::array<std::int64_t, kMaxLevels + 1> first_{};
};

// Position of a node of a level along the Hilbert curve of that level's 2^order x 2^order square: the four
// children of a node are neighbours in this order.
std::uint64_t hilbert_index(std::int32_t x, std::int32_t y, int order);

}  // namespace ridgeline::io
