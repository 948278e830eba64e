// How far a level's surface lies from the source, at every valid sample: the true error, not the propagated
// one.
//
// The surface at a vertex that a level lacks is the mean of its hypotenuse's ends, from coarse to fine. A
// block needs nothing from outside but the surface at its own corners, which CornerSurfaces knows for the
// levels whose nodes are larger than blocks.
//
// Thread rules: a SurfaceErrors belongs to one thread; CornerSurfaces is immutable.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ridgeline/build/block_levels.h"
#include "ridgeline/build/blocks.h"
#include "ridgeline/build/coarse_lattice.h"
#include "ridgeline/build/levels.h"
#include "ridgeline/build/vertex_errors.h"

namespace ridgeline::build {

class CornerSurfaces {
  public:
    CornerSurfaces(const io::Grid& grid, const BlockGrid& blocks, const CoarseLattice& lattice,
                   const Levels& levels);

    // At the corners of a block, in quarter order; quanta.
    std::array<double, 4> at(int level, io::LatticePoint block_origin) const;

  private:
    std::int64_t columns_ = 0, rows_ = 0;  // of points kBlock apart, over all the roots
    std::vector<std::vector<double>> surfaces_;
};

class SurfaceErrors {
  public:
    // What the block's heights lie between; quanta.
    struct Bounds {
        std::int32_t least = 0, greatest = 0;
    };
    void set_block(const VertexErrors& errors, const BlockLevels& levels, const Bounds& bounds,
                   bool all_valid);
    // The greatest error of a level in each of nodes_a_side^2 equal squares of the block, borders included,
    // row by row; quanta. What rounding in here can have hidden is added.
    void measure(int level, const std::array<double, 4>& corners, int nodes_a_side,
                 std::vector<float>& errors);

  private:
    static constexpr int kEighths = kBlock / 8;

    void find_eighth_surface(std::uint8_t level, const std::array<double, 4>& corners);
    void refine(int scale, std::uint8_t level, const std::vector<float>& coarse,
                std::vector<float>& fine) const;
    void widen_even_row(int row, std::uint8_t level);
    void widen_odd_row(int row, std::uint8_t level);
    void close_nodes(int nodes_a_side, float* errors);

    const BlockLevels* levels_ = nullptr;
    double base_ = 0.0;   // heights are relative to it, so that floats suffice
    double range_ = 0.0;  // how far from it they lie
    float slack_ = 0.0f;  // bounds what rounding does to the surface being measured
    Phases<float> heights_[kFineScales];
    std::vector<float> eighth_heights_;
    Phases<std::uint8_t> judged_;  // the levels at scale 1, 0 where the sample is invalid: there is no error
    std::vector<std::uint8_t> even_valid_;     // 0 or 1
    std::vector<float> surface_[kFineScales];  // at steps 8, 4, 2
    std::vector<float> even_most_, odd_most_;  // by column, of the current row of nodes
};

}  // namespace ridgeline::build
