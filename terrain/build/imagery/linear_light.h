// Means of sRGB-coded texels, taken in linear light: what a smaller picture shows of a larger one.
//
// Thread rules: pure functions, any thread.
#pragma once

#include <span>

#include "ridgeline/build/imagery/texel_rows.h"

namespace ridgeline::build {

// `from` is side² texels, side even; `to` (side / 2)² means of 2×2 each. Texels without imagery do not count;
// where all four are without, so is the mean. A mean of equal texels is that texel.
void halve(std::span<const Texel> from, int side, std::span<Texel> to);

}  // namespace ridgeline::build
