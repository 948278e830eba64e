// Where the bands and cells of a relief lie on its node's lattice, and the codes of heights. Shared by those
// who make, store and read reliefs.
#pragma once

#include <algorithm>
#include <cstdint>

#include "ridgeline/io/relief.h"

namespace ridgeline::io {

// Both ends included.
struct LatticeRange {
    int first = 0, last = 0;
    int count() const { return last - first + 1; }
};

// The lattice rows (for chains that run east; else columns) on which a band's vertices may stand.
constexpr LatticeRange band_range(const ReliefShape& shape, int quads, int band) {
    return {(band * quads + shape.bands - 1) / shape.bands, (band + 1) * quads / shape.bands};
}
// The lattice rows or columns that cover a cell of the maxima.
constexpr LatticeRange cell_range(const ReliefShape& shape, int quads, int cell) {
    return {cell * quads / shape.cells, ((cell + 1) * quads + shape.cells - 1) / shape.cells};
}

// Chain heights are kept in 4096 steps between a node's least and greatest height: codes of which the lower
// four bits say nothing, so that they need not be stored.
namespace chain_step {
constexpr int kDroppedBits = 4;
constexpr int kMost = (chain_height::kMost - 1) >> kDroppedBits;
constexpr std::uint16_t code(int step) { return static_cast<std::uint16_t>((step << kDroppedBits) + 1); }
constexpr int of(std::uint16_t code) { return (code - 1) >> kDroppedBits; }
}  // namespace chain_step

// Where a height lies between least and greatest, in `steps` equal steps; rounded down.
constexpr int step_below(std::int32_t quanta, const NodeRecord& record, int steps) {
    const std::int64_t range = std::int64_t{record.max_quanta} - record.min_quanta;
    if (range <= 0) return 0;
    const std::int64_t above = std::clamp<std::int64_t>(std::int64_t{quanta} - record.min_quanta, 0, range);
    return static_cast<int>(above * steps / range);
}

}  // namespace ridgeline::io
