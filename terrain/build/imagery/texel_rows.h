// The imagery that the builder takes: rows of texels on a north-up lattice in the store's CRS, whatever they
// come from.
//
// Thread rules: one thread at a time.
#pragma once

#include <cstdint>
#include <span>

#include "ridgeline/base/result.h"
#include "ridgeline/io/imagery_info.h"

namespace ridgeline::build {

// An sRGB-coded colour; alpha is 255, or 0 where there is no imagery, and then the colour means nothing.
struct Texel {
    std::uint8_t red = 0, green = 0, blue = 0, alpha = 0;

    friend constexpr bool operator==(const Texel&, const Texel&) = default;
};
static_assert(sizeof(Texel) == 4);
constexpr std::uint8_t kOpaque = 255;

class TexelRows {
  public:
    virtual ~TexelRows() = default;

    // The lattice, sources and notes; tiles and bytes are the builder's.
    virtual const io::ImageryInfo& info() const = 0;
    // Rows [row, row + rows) at full width, northmost first.
    virtual Result<void> read(std::int64_t row, std::int64_t rows, std::span<Texel> texels) = 0;
};

}  // namespace ridgeline::build
