// A sample as the scratch raster holds it: quanta and two validity bits in one 32-bit word.
#pragma once

#include <cstdint>
#include <limits>

namespace ridgeline::build {

// Heights reach from -kMaxQuanta to kMaxQuanta, so that 2*v - a - b fits 32 bits and packing loses nothing.
constexpr std::int32_t kMaxQuanta = 1 << 28;
// Among heights, says that there is none.
constexpr std::int32_t kNoHeight = std::numeric_limits<std::int32_t>::min();

namespace sample {
constexpr std::int32_t kValid = 1;
// Of the cell with this sample in its north-western corner: all four corners are valid; on a coarser lattice,
// some finest cell under it is.
constexpr std::int32_t kCellValid = 2;
constexpr std::int32_t kFlags = 3;

// Quanta times four, without flags.
constexpr std::int32_t pack(std::int32_t quanta) { return quanta * 4; }
constexpr std::int32_t quanta(std::int32_t packed) { return packed >> 2; }
}  // namespace sample

}  // namespace ridgeline::build
