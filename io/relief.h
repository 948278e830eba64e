// Relief: what a node can hide, and how high it reaches, without its mesh.
//
// Chains (the horizon paper's potential silhouettes, 3.2) lie on or under everything that may be drawn for
// the node, in every morph state; maxima lie on or over it, and over everything that may be drawn for its
// descendants. Both are codes within the node record's heights, so a relief has a fixed size and no header.
// It travels in the mesh payload and lies in the chunk's block (chunk.h). Plain views; whoever owns the block
// owns the bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "ridgeline/io/node_record.h"

namespace ridgeline::io {

// Of a whole store.
struct ReliefShape {
    // Chains on each axis. Even, so that every chain lies in one half of the node.
    int bands = 10;
    // Segments of a chain. Even, so that the first half of them lies in one quarter.
    int steps = 16;
    // Cells on a side of the grid of maxima. Even; at most 64, so that a quarter is four blocks of eight (the
    // horizon looks at blocks, then at their cells).
    int cells = 32;

    // Whether nodes of that many quads a side can have it: every vertex then stands at a lattice column of
    // the node, every band holds a lattice row.
    bool fits(int quads) const {
        const auto possible = [quads](int n) { return n >= 2 && n % 2 == 0 && n <= quads; };
        return possible(bands) && possible(steps) && possible(cells) && cells <= 64 && quads % steps == 0;
    }
    int chains() const { return 2 * bands; }
    int chain_vertices() const { return chains() * (steps + 1); }
    // Per node: three bytes a chain vertex, one a cell.
    std::size_t bytes() const { return static_cast<std::size_t>(3 * chain_vertices() + cells * cells); }
};

// Chains of axis `east` run eastwards: vertex i stands at column i * extent / steps, row across * extent /
// quads; those of axis `south` the same with columns and rows exchanged.
enum class ReliefAxis : std::uint8_t { east, south };

// Height codes of chains. A vertex of code kHidesNothing ends the segments at it: there is no ground, or none
// that could hide. Rounded down, so that decoding stays under the surface.
namespace chain_height {
constexpr std::uint16_t kHidesNothing = 0;
constexpr std::uint16_t kMost = 65535;
// Quanta that a code other than kHidesNothing stands for.
inline float quanta(std::uint16_t code, const NodeRecord& record) {
    const float range = static_cast<float>(record.max_quanta) - static_cast<float>(record.min_quanta);
    return static_cast<float>(record.min_quanta) + range * (static_cast<float>(code - 1) / 65534.0f);
}
}  // namespace chain_height

// The greatest code of a maximum.
constexpr int kMostMaximum = 255;
// Quanta that a maximum's code stands for; rounded up when encoded.
inline float maximum_quanta(std::uint8_t code, const NodeRecord& record) {
    const float range = static_cast<float>(record.max_quanta) - static_cast<float>(record.min_quanta);
    return static_cast<float>(record.min_quanta) +
           range * (static_cast<float>(code) / static_cast<float>(kMostMaximum));
}

class ReliefView {
  public:
    ReliefView() = default;
    // bytes: shape.bytes() of them, aligned to two: heights of all chains, then maxima, then acrosses.
    ReliefView(std::span<std::byte> bytes, const ReliefShape& shape) : bytes_(bytes), shape_(shape) {}

    explicit operator bool() const { return !bytes_.empty(); }
    const ReliefShape& shape() const { return shape_; }

    // steps + 1 codes. Band b's chain lies within the b-th equal share of the node's breadth.
    std::span<std::uint16_t> heights(ReliefAxis axis, int band) const {
        return {reinterpret_cast<std::uint16_t*>(bytes_.data()) + first(axis, band), vertices()};
    }
    // steps + 1 places, in cells of the node's lattice, 0 to quads.
    std::span<std::uint8_t> across(ReliefAxis axis, int band) const {
        return {octets() + 2 * all_vertices() + cell_count() + first(axis, band), vertices()};
    }
    // cells * cells codes, row by row from the north-west.
    std::span<std::uint8_t> maxima() const { return {octets() + 2 * all_vertices(), cell_count()}; }

  private:
    std::size_t vertices() const { return static_cast<std::size_t>(shape_.steps + 1); }
    std::size_t all_vertices() const { return static_cast<std::size_t>(shape_.chain_vertices()); }
    std::size_t cell_count() const { return static_cast<std::size_t>(shape_.cells * shape_.cells); }
    std::size_t first(ReliefAxis axis, int band) const {
        return static_cast<std::size_t>(static_cast<int>(axis) * shape_.bands + band) * vertices();
    }
    std::uint8_t* octets() const { return reinterpret_cast<std::uint8_t*>(bytes_.data()); }

    std::span<std::byte> bytes_;
    ReliefShape shape_;
};

}  // namespace ridgeline::io
