// The coarsest level of every vertex of a block: by phase, for loops over rows, and as a dense square, for
// encoding.
#pragma once

#include <cstdint>
#include <vector>

#include "ridgeline/build/blocks.h"
#include "ridgeline/build/coarse_lattice.h"
#include "ridgeline/build/levels.h"
#include "ridgeline/build/vertex_errors.h"

namespace ridgeline::build {

struct BlockLevels {
    static constexpr int kSide = kErrorCells + 1;

    Phases<std::uint8_t> phases[kFineScales];  // even is unused
    std::vector<std::uint8_t> eighth;          // every eighth vertex, from kErrorApron before the block on
    std::vector<std::uint8_t> dense;           // kSide rows of kSide

    void find(const VertexErrors& errors, const CoarseLattice& lattice, const Levels& levels,
              io::LatticePoint block_origin);
    // Column and row count from the block's corner; exact up to kExactApron beyond it.
    const std::uint8_t* from(std::int64_t column, std::int64_t row) const {
        return &dense[static_cast<std::size_t>((row + kErrorApron) * kSide + column + kErrorApron)];
    }
    std::uint8_t at(std::int64_t column, std::int64_t row) const { return *from(column, row); }

  private:
    std::vector<std::uint8_t> quarter_, half_;  // every fourth and second vertex
};

}  // namespace ridgeline::build
