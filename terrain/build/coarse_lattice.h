// What is kept in memory of the whole raster: every eighth sample, coarser lattices of it, and the errors of
// the vertices on them. A 64th of the raster, and a third of that.
//
// Blocks hand up heights and the errors of scale 4; finish() decimates and goes on with scales 8 and coarser
// as VertexErrors does below. Beyond the raster heights repeat; errors reach a little further than it.
//
// Thread rules: hand_up for different blocks from any threads; finish from one; everything const from any
// after it.
#pragma once

#include <cstdint>
#include <vector>

#include "ridgeline/build/block_window.h"
#include "ridgeline/build/blocks.h"
#include "ridgeline/build/levels.h"
#include "ridgeline/build/samples.h"
#include "ridgeline/build/vertex_errors.h"
#include "ridgeline/io/grid.h"

namespace ridgeline::build {

class CoarseLattice {
  public:
    // The finest lattice's step is 2^kFirstScale samples.
    static constexpr int kFirstScale = 3;

    CoarseLattice(const io::Grid& grid, const VertexMetric& metric);

    void hand_up(const BlockGrid& blocks, std::int64_t block, const BlockWindow& window,
                 const VertexErrors& errors);
    void finish();

    // The packed sample at a point of the lattice of step 2^scale, counted in steps. Beyond the raster, the
    // nearest sample without flags.
    std::int32_t sample(int scale, std::int64_t column, std::int64_t row) const;
    // In finest samples; both must be multiples of 8.
    std::int32_t quanta(std::int64_t x, std::int64_t y) const {
        return sample::quanta(sample(kFirstScale, x >> kFirstScale, y >> kFirstScale));
    }
    // The propagated error of a vertex of scale 8 or more, within the roots.
    std::uint8_t code(std::int64_t x, std::int64_t y) const;
    // The coarsest level that holds it, for its error or its place.
    std::uint8_t level(const Levels& levels, std::int64_t x, std::int64_t y) const;
    // Calls visit(x, y, code) for every vertex of scale 8 or more in [x0, x0 + size) x [y0, y0 + size).
    template <class Visit>
    void for_each_code(io::LatticePoint origin, std::int64_t size, Visit&& visit) const {
        constexpr std::int64_t kStep = std::int64_t{1} << kFirstScale;
        for (std::int64_t y = origin.y; y < origin.y + size; y += kStep)
            for (std::int64_t x = origin.x; x < origin.x + size; x += kStep) visit(x, y, code(x, y));
    }

  private:
    struct Samples {
        std::int64_t columns = 0, rows = 0;
        std::vector<std::int32_t> packed;
    };
    // Codes of one scale, as in Phases; cells reach past the raster as far as errors can.
    struct Codes {
        std::int64_t columns = 0, rows = 0;
        std::vector<std::uint8_t> x, y, centre;

        std::uint8_t at(const std::vector<std::uint8_t>& phase, std::int64_t column, std::int64_t row) const {
            const bool inside = column >= 0 && row >= 0 && column < columns && row < rows;
            return inside ? phase[static_cast<std::size_t>(row * columns + column)] : std::uint8_t{0};
        }
    };
    const Codes& codes(int scale) const { return codes_[static_cast<std::size_t>(scale - kFirstScale + 1)]; }
    static Samples decimate(const Samples& fine);
    Codes find_codes(int scale) const;
    std::uint8_t own_code(int scale, io::LatticePoint vertex, io::LatticePoint a, io::LatticePoint b) const;
    std::uint8_t cone_code(int scale, io::LatticePoint vertex) const;

    io::Grid grid_;
    VertexMetric metric_;
    std::vector<Samples> samples_;  // from scale 3 up to the roots' extent
    std::vector<Codes> codes_;      // from scale 2, of which only centres, up to half the roots' extent
};

}  // namespace ridgeline::build
