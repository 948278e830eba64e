// How coarse each level may be: thresholds from the histogram of all vertices' error codes, so that nodes of
// every level hold about as many vertices, and none too many.
//
// Thread rules: BlockCounts belongs to one thread at a time; Thresholds likewise.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ridgeline/build/blocks.h"
#include "ridgeline/build/coarse_lattice.h"
#include "ridgeline/build/error_code.h"
#include "ridgeline/build/vertex_errors.h"
#include "ridgeline/io/grid.h"

namespace ridgeline::build {

// By code; or, as limits to choose from, by threshold: vertices whose code is greater.
using Histogram = std::array<std::uint32_t, kErrorCodes>;

struct VertexBudget {
    // About 4 000 triangles a node, on average.
    std::int64_t mean = 2000;
    // For the roughest node: decoding and drawing one chunk stays cheap, and fans still fit 16-bit indices.
    std::int64_t most = 12000;
};

// The vertices of one block, by the nodes of every level that lies within blocks.
class BlockCounts {
  public:
    BlockCounts(const io::Grid& grid, const BlockGrid& blocks);

    void clear();
    // Vertices of scales 1, 2, 4, of the block without its eastern and southern border.
    void add_fine(const VertexErrors& errors);
    // Those of scales 8 and more.
    void add_coarse(const CoarseLattice& lattice, io::LatticePoint block_origin);
    // Sums up; after all adds.
    void finish();

    const Histogram& whole() const { return whole_; }
    // For each level from the finest to the blocks' top: by threshold, the most vertices that a node has.
    const std::vector<Histogram>& most() const { return most_; }

  private:
    Histogram& node(int column, int row) {
        return nodes_[static_cast<std::size_t>(row) * static_cast<std::size_t>(nodes_a_side_) +
                      static_cast<std::size_t>(column)];
    }
    void add_phase(const Phases<std::uint8_t>& shape, const std::vector<std::uint8_t>& phase, int first,
                   int cells);

    int quads_;
    int nodes_a_side_;
    std::vector<Histogram> nodes_;  // of the finest level
    Histogram whole_{};
    std::vector<Histogram> most_;
};

class Thresholds {
  public:
    Thresholds(const io::Grid& grid, const BlockGrid& blocks, const VertexBudget& budget);

    // A block's fine and its coarse vertices may come apart: the most that any node has is then bounded by
    // the sum of the two greatest.
    enum class Part { fine, coarse };
    void add(std::int64_t block, Part part, const BlockCounts& counts);
    // nodes: by level, how many have data. The result is what Levels takes.
    std::vector<std::uint8_t> choose(const std::vector<std::int64_t>& nodes) const;

  private:
    std::vector<Histogram> most_in_coarse_levels() const;

    io::Grid grid_;
    BlockGrid blocks_;
    VertexBudget budget_;
    std::vector<Histogram> block_counts_;
    std::vector<Histogram> most_[2];
};

}  // namespace ridgeline::build
