// What suite `stress` looks for in a frame: holes, tiles that are not there, bytes over the caches.
//
// Render thread; reading a picture waits for the GPU.
#pragma once

#include <cstdint>

#include "ridgeline/app/options.h"
#include "ridgeline/app/walk/stage.h"
#include "ridgeline/gl/screenshot.h"

namespace ridgeline::app {

// Of the pictures that are looked at; ground never has it.
inline constexpr render::PlainBackground kStressBackground{255, 0, 255};

// The camera is the moment's, its eye as lifted as the report says.
std::int64_t wrong_background(const gl::Image& image, const StageMoment& moment, const StageReport& report);

std::int64_t differing_pixels(const gl::Image& a, const gl::Image& b);

// Of all that the last frame wanted, what came into view and what may come: not on the GPU.
std::int64_t missing_tiles(TerrainStage& stage, const StageReport& report);

// In RAM and on the GPU together, beyond what was asked for either cache.
std::int64_t bytes_over_budget(const TerrainStage& stage, const CacheSizes& asked);

// Nothing that was wanted is under way, and nothing changes by itself any more. Tiles that failed, or for
// which there is no room, may be missing.
bool at_rest(const TerrainStage& stage);

}  // namespace ridgeline::app
