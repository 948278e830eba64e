// Imagery of the rasters that GDAL reads, over a terrain.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ridgeline/base/units.h"
#include "ridgeline/build/imagery/texel_rows.h"
#include "ridgeline/io/terrain_info.h"

namespace ridgeline::build {

struct ImageSources {
    std::vector<std::string> paths;       // later ones cover earlier ones
    std::uint64_t cache_bytes = 128_MiB;  // GDAL's
    int threads = 1;                      // for decoding and warping
};

// On the lattice of the finest of them, clipped to the terrain; what does not lie on it is warped.
Result<std::unique_ptr<TexelRows>> open_imagery(const ImageSources& sources, const io::TerrainInfo& terrain);

}  // namespace ridgeline::build
