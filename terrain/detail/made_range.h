// Between which heights ground lies that is still to be made: for what passes over it without making it. Pure; any thread.
#pragma once

#include <cstdint>
#include <span>

#include "ridgeline/detail/detail_tile.h"

namespace ridgeline::detail {

// Heights in a tile's units.
struct UnitRange {
    std::int64_t least = 0, most = 0;
};

// Of a quarter of a tile, and of all that is made of it in so many octaves, gains by octave. Generous, not a bound: of what
// it adds to the samples, ground that was tried takes up a tenth.
UnitRange made_range(const DetailTile& parent, int quarter, std::span<const io::DetailGains> gains);

// The same of ground of which is known only that its samples, and those about it, lie within a range.
UnitRange made_range(const UnitRange& samples, std::span<const io::DetailGains> gains);

}  // namespace ridgeline::detail
