// What encoder and decoder keep of a chunk while they work, and what the relief is made from afterwards.
// Private to the room.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "ridgeline/io/bisection.h"
#include "ridgeline/io/chunk_codec.h"
#include "ridgeline/io/chunk_sides.h"
#include "ridgeline/io/payload_bytes.h"

namespace ridgeline::io {

struct ChunkScratch::State {
    Bisection bisection;
    ChunkSides sides;
    BitWriter split_bits, parent_bits, fan_bits;
    std::vector<std::uint32_t> residuals;
    std::vector<std::uint8_t> bytes;
    // By vertex of the bisection: own height, and the parent's surface there.
    std::vector<std::int32_t> quanta;
    std::vector<std::uint8_t> in_parent;
    std::vector<double> parent_surface;
};

inline std::int32_t round_to_quantum(double quanta) {
    const double shifted = quanta + 0.5;
    const auto cut = static_cast<std::int32_t>(shifted);
    return cut - (static_cast<double>(cut) > shifted ? 1 : 0);
}
inline bool has_fans(const Grid& grid, NodeId node) { return node.level < grid.finest(); }

}  // namespace ridgeline::io
