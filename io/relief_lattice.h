// Where the bands and cells of a relief lie on its node's lattice, and the codes of heights. Shared by those
// who make, store and read reliefs.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

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
constexpr double kSteps = static_cast<double>(chain_height::kMost - 1) / (1 << kDroppedBits);
constexpr int kMost = static_cast<int>(kSteps);
constexpr std::uint16_t code(int step) { return static_cast<std::uint16_t>((step << kDroppedBits) + 1); }
constexpr int of(std::uint16_t code) { return (code - 1) >> kDroppedBits; }
}  // namespace chain_step

// Where a height lies between a node's least and greatest, in equal steps (not always a whole number of
// them); rounded down, give or take what a double's rounding does, which is the same on every machine.
class HeightSteps {
  public:
    HeightSteps(const NodeRecord& record, double steps)
        : least_(record.min_quanta), most_(record.max_quanta), most_step_(static_cast<int>(steps)) {
        const double range = static_cast<double>(record.max_quanta) - record.min_quanta;
        per_quantum_ = range > 0.0 ? steps / range : 0.0;
    }
    int below(double quanta) const {
        const double inside = std::clamp(quanta, static_cast<double>(least_), static_cast<double>(most_));
        return std::min(static_cast<int>((inside - least_) * per_quantum_), most_step_);
    }

  private:
    std::int32_t least_, most_;
    int most_step_;
    double per_quantum_;
};

// The greatest value over the lattice points of every cell, row by row. lattice: the north-western of
// (quads + 1)^2 points, rows `stride` apart. row_scratch is working memory.
template <class T>
void greatest_by_cell(const ReliefShape& shape, int quads, const T* lattice, std::ptrdiff_t stride,
                      std::vector<T>& row_scratch, std::vector<T>& greatest) {
    row_scratch.resize(static_cast<std::size_t>(quads) + 1);
    greatest.clear();
    for (int row = 0; row < shape.cells; ++row) {
        const LatticeRange rows = cell_range(shape, quads, row);
        std::copy_n(lattice + rows.first * stride, quads + 1, row_scratch.begin());
        for (int y = rows.first + 1; y <= rows.last; ++y)
            for (int x = 0; x <= quads; ++x)
                row_scratch[static_cast<std::size_t>(x)] =
                    std::max(row_scratch[static_cast<std::size_t>(x)], lattice[y * stride + x]);
        for (int column = 0; column < shape.cells; ++column) {
            const LatticeRange columns = cell_range(shape, quads, column);
            greatest.push_back(*std::max_element(row_scratch.begin() + columns.first,
                                                 row_scratch.begin() + columns.last + 1));
        }
    }
}

}  // namespace ridgeline::io
