// The unevenness of bare ground: a tileable texture of values in [0, 1] whose octaves fall off as natural
// patterns do.
#pragma once

#include <cstdint>
#include <vector>

#include "ridgeline/base/result.h"
#include "ridgeline/gl/texture.h"

namespace ridgeline::render {

// size_px * size_px values, rows one after another; size_px a power of two. Depends on its arguments alone.
std::vector<std::uint8_t> ground_noise(int size_px, std::uint32_t seed);

// With mips, so that it averages out with distance.
Result<gl::Texture2D> create_ground_noise();

}  // namespace ridgeline::render
