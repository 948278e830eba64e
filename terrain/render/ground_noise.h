// The unevenness of bare ground: a tileable texture of values in [0, 1] whose octaves fall off as natural
// patterns do.
#pragma once

#include <cstdint>
#include <vector>

#include "ridgeline/base/result.h"
#include "ridgeline/gl/texture.h"

namespace ridgeline::render {

// One texel: the value, and its slopes eastwards and northwards (0.5 is level), from which shading makes
// bumps.
struct NoiseTexel {
    std::uint8_t value = 0;
    std::uint8_t slope_east = 0;
    std::uint8_t slope_north = 0;
    std::uint8_t unused = 255;
};
static_assert(sizeof(NoiseTexel) == 4);

// size_px * size_px texels, rows one after another; size_px a power of two. Depends on its arguments alone.
std::vector<NoiseTexel> ground_noise(int size_px, std::uint32_t seed);

// With mips, so that it averages out with distance.
Result<gl::Texture2D> create_ground_noise();

}  // namespace ridgeline::render
