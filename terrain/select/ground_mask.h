// Which ground a picture shows, coarsely: nested grids of 64 x 64 cells about the eye, each of cells twice as
// wide as the one within.
//
// Beyond the innermost grid a cell is a thirty-second to a sixteenth of its distance wide, wherever it lies,
// as the tiles that the mask decides on are of some part of theirs; and a place finds its cell without
// knowing what else is seen: a single pass over a picture fills the mask, be it on the GPU. Cells lie on a
// lattice fixed to the terrain; masks about different eyes agree on their borders.
//
// A plain value of fixed size; nothing allocates.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>

namespace ridgeline::select {

// World metres, east and north. Empty where a min exceeds its max.
struct GroundRectangle {
    glm::dvec2 min{std::numeric_limits<double>::infinity()};
    glm::dvec2 max{-std::numeric_limits<double>::infinity()};

    bool empty() const { return !(min.x <= max.x && min.y <= max.y); }
    void add(const GroundRectangle& other) {
        min = glm::min(min, other.min);
        max = glm::max(max, other.max);
    }
    // What lies in both.
    GroundRectangle within(const GroundRectangle& other) const {
        return {glm::max(min, other.min), glm::min(max, other.max)};
    }
};

// Where the cells of a terrain's masks lie. Cells count from the south-western corner, eastwards and
// northwards.
struct GroundLattice {
    glm::dvec2 corner_m{0.0};
    double cell_m = 1.0;  // of the innermost grid
    double cells_per_m = 1.0;
    glm::ivec2 cells{1};  // over the terrain

    GroundLattice() = default;
    // terrain: all ground there is. Wherever the eye is, the outermost grid holds it.
    explicit GroundLattice(const GroundRectangle& terrain);

    // The cell of a place; of the nearest place on the terrain where it lies outside.
    glm::ivec2 cell(const glm::dvec2& place_m) const;
};

class GroundMask {
  public:
    static constexpr int kSide = 64;
    static constexpr int kGrids = 12;
    static constexpr int kWords = kGrids * kSide;

    GroundMask() = default;

    // Nothing is seen, about an eye.
    void clear(const GroundLattice& lattice, const glm::dvec2& eye_m);

    // All of a rectangle is seen.
    void mark(const GroundRectangle& area);
    // What was counted elsewhere, about the same eye: grid by grid, row by row from the south, bit 0 the
    // westernmost cell; each place in the innermost grid that holds it.
    void mark(std::span<const std::uint64_t, kWords> words);
    // Cells beside seen ones count as seen.
    void widen();

    // Whether something is seen in an area, its eastern and northern borders not included. The answer is that
    // of the cells that it touches, in the innermost grid that holds it with a cell to spare.
    bool any(const GroundRectangle& area) const;
    // Whether the cell of a place in the innermost grid that holds it is seen.
    bool seen_at(const glm::dvec2& place_m) const;

    const GroundLattice& lattice() const { return lattice_; }
    const glm::ivec2& centre() const { return centre_; }  // cell of the eye
    std::span<const std::uint64_t, kWords> words() const { return words_; }

  private:
    // Cells in a grid, both ends included.
    struct Range {
        glm::ivec2 first{0}, last{-1};
    };
    // The cells of the innermost grid's size that an area touches.
    Range cells_of(const GroundRectangle& area) const;
    // The same in a grid's own count, from its south-western cell.
    Range in_grid(const Range& cells, int grid) const;
    std::uint64_t& row(int grid, int y) { return words_[static_cast<std::size_t>(grid * kSide + y)]; }
    std::uint64_t row(int grid, int y) const { return words_[static_cast<std::size_t>(grid * kSide + y)]; }

    GroundLattice lattice_;
    glm::ivec2 centre_{0};
    // Each grid holds what the ones within hold, too.
    std::array<std::uint64_t, kWords> words_{};
};

}  // namespace ridgeline::select
