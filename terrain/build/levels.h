// Which vertices the levels' meshes hold: from an error's code, or from the place alone.
//
// A level holds every vertex whose propagated error exceeds its threshold; and, whatever their errors,
// corners, side midpoints, centre and quarter centres of its nodes. Both are closed under ancestry and nested
// from level to level, and depend on the vertex alone, so that neighbours agree on shared borders.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ridgeline/build/error_code.h"
#include "ridgeline/io/grid.h"

namespace ridgeline::build {

// Of a lattice point: the largest power of two that divides both coordinates, as a logarithm, and whether the
// point is a centre of that scale. (0, 0) has scale kTopScale.
struct VertexKind {
    static constexpr int kTopScale = 62;
    int scale = 0;
    bool centre = false;
};
VertexKind vertex_kind(std::int64_t x, std::int64_t y);

class Levels {
  public:
    Levels() = default;
    // thresholds: the greatest code that a level leaves out, coarsest first, never increasing.
    Levels(const io::Grid& grid, const std::vector<std::uint8_t>& thresholds);

    // The coarsest level that holds a vertex; levels() where none does.
    std::uint8_t of_code(std::uint8_t code) const { return of_code_[code]; }
    std::uint8_t of_place(VertexKind kind) const;
    std::uint8_t levels() const { return static_cast<std::uint8_t>(thresholds_.size()); }

    // of_code for a row of codes. Codes and levels may be the same memory.
    void translate(const std::uint8_t* codes, std::size_t count, std::uint8_t* levels) const;

  private:
    std::vector<std::uint8_t> thresholds_;
    std::array<std::uint8_t, kErrorCodes> of_code_{};
    int finest_ = 0;
    int log_quads_ = 0;
};

}  // namespace ridgeline::build
