// Views for pictures of the skyline, chosen among random eyes by the source's skyline alone: what simplified
// surfaces make of it has no say.
//
// Pure; any thread.
#pragma once

#include <span>
#include <vector>

#include "ridgeline/app/bench/surface_errors.h"
#include "ridgeline/platform/camera.h"

namespace ridgeline::app {

struct SkylineViewOptions {
    platform::Lens lens;
    int columns = 720;  // of each eye's skyline, all round
    // Skylines nearer than so many samples are not simplified, and count for nothing.
    double from_samples = 128.0;
};

// At most four poses, each of another eye, with the skyline in the picture's upper half: the one that sees
// the longest skyline, of the eyes close to the ground and of those high above it the one that does, and the
// next best. Fewer where there are fewer such eyes; ground in the distance is needed.
std::vector<platform::Pose> choose_skyline_views(const io::TerrainInfo& info, const SurfaceField& source,
                                                 std::span<const Eye> eyes,
                                                 const SkylineViewOptions& options);

}  // namespace ridgeline::app
