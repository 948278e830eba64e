// Pictures of suite `synthesis`: one camera, four grounds.
//
//   the real ground            | every so manieth of its samples
//   as many made below those   | as many as the store foretells
//
// Drawn by the disc of the frame that walks draw with, all tiles there. Render thread, with a GL context current.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "ridgeline/base/result.h"
#include "ridgeline/io/store.h"
#include "ridgeline/jobs/job_system.h"
#include "ridgeline/platform/camera.h"

namespace ridgeline::app {

struct SynthesisPictureOptions {
    std::filesystem::path folder;
    // Of one ground.
    platform::Lens lens{.horizontal_fov = Angle::from_degrees(60.0), .size_px = {640, 400}};
    // Where views look from, in the store's CRS: one close to the ground, one from a slope's height, one from far above,
    // one straight down.
    platform::Pose start;
};

// Writes synthesis-1.png, -2.png, ...: those views, and one of a level shore where the ground has any. Stores of the same
// ground; octaves: that bring the decimated one to the other's spacing. Returns how many.
Result<int> draw_synthesis(const io::Store& real, const io::Store& decimated, int octaves,
                           jobs::JobSystem& jobs, const SynthesisPictureOptions& options);

}  // namespace ridgeline::app
