// A block's samples with an apron, ready to work on: heights without gaps, flags apart.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ridgeline/build/blocks.h"
#include "ridgeline/build/samples.h"
#include "ridgeline/build/void_fill.h"
#include "ridgeline/io/grid.h"

namespace ridgeline::build {

class BlockWindow {
  public:
    // Takes a window as ScratchRaster reads it apart into heights and flags, within the raster.
    void unpack(const io::Grid& grid, io::LatticePoint block_origin, std::span<const std::int32_t> packed);
    // Some sample of the raster in the window is invalid, so that fill() is due.
    bool has_voids() const { return has_voids_; }
    void fill(const VoidFill& fill) { fill.fill_window(frame_, quanta_, flags_, fill_scratch_); }
    void set_means(const BlockGrid& blocks, std::int64_t block, VoidFill& fill) {
        fill.set_means(blocks, block, quanta_, flags_, fill_scratch_);
    }
    // Repeats the raster's border samples outwards, without flags. Last, after the fill.
    void pad();

    // Every sample of the window lies in the raster and is valid.
    bool complete() const { return complete_; }
    std::span<const std::int32_t> quanta() const { return quanta_; }
    // Empty where complete.
    std::span<const std::uint8_t> flags() const {
        return complete_ ? std::span<const std::uint8_t>() : std::span<const std::uint8_t>(flags_);
    }

    // Column and row count from the block's corner.
    static std::size_t at(std::int64_t column, std::int64_t row) {
        return static_cast<std::size_t>((row + kWindowApron) * kWindow + column + kWindowApron);
    }

  private:
    WindowFrame frame_;
    bool complete_ = false;
    bool has_voids_ = false;
    std::vector<std::int32_t> quanta_;
    std::vector<std::uint8_t> flags_;
    VoidFill::Scratch fill_scratch_;
};

}  // namespace ridgeline::build
