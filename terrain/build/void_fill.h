// Heights where the source has none: a smooth fill that continues the valid surroundings into every hole.
//
// Push-pull over the nested lattices: weighted means of what is valid are pushed to coarser lattices until
// all is covered, and pulled back where weight is missing. The fill of a sample depends on its position
// alone, never on the window in which it is computed: lattices of 8 finest samples and coarser are held for
// the whole raster here, those of 4, 2 and 1 come from the window around.
//
// Thread rules: set_means for different points from any threads; finish from one; then fill_window from any.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ridgeline/build/blocks.h"
#include "ridgeline/io/grid.h"

namespace ridgeline::build {

// Where a block's window lies on the raster, in samples of the window.
struct WindowFrame {
    WindowFrame() = default;
    WindowFrame(const io::Grid& grid, io::LatticePoint block_origin);
    // The raster's samples in the window: [first, last) of columns and rows.
    int first_x = 0, last_x = 0, first_y = 0, last_y = 0;
    // The lattice coordinates of the window's first sample; may be negative.
    std::int64_t west = 0, north = 0;
};

class VoidFill {
  public:
    explicit VoidFill(const io::Grid& grid);

    // Working memory, reused from window to window; one a thread.
    struct Scratch {
        struct Lattice {
            int size = 0;  // points a side
            std::vector<float> mean, weight;
        };
        Lattice lattices[4];  // steps 1, 2, 4, 8
    };

    // Pushes the window's valid samples to the 8-lattice and keeps the means of the block's points.
    void set_means(const BlockGrid& blocks, std::int64_t block, std::span<const std::int32_t> quanta,
                   std::span<const std::uint8_t> flags, Scratch& scratch);
    // Pushes on to the coarsest lattice and pulls back to the 8-lattice.
    void finish();
    // Fills the raster's invalid samples; exact for those at least 8 samples within the window.
    void fill_window(const WindowFrame& frame, std::span<std::int32_t> quanta,
                     std::span<const std::uint8_t> flags, Scratch& scratch) const;

  private:
    struct Lattice {
        std::int64_t columns = 0, rows = 0;
        std::vector<float> mean, weight;
    };

    static Lattice push(const Lattice& fine);
    static void pull(const Lattice& coarse, Lattice& fine);
    static void settle(Lattice& coarsest);

    Lattice eighth_;  // after finish(), mean holds the filled values and weight is empty
};

}  // namespace ridgeline::build
