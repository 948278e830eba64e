// Loading GL's functions, and what this GPU and driver are and can. Render thread only.
#pragma once

#include <glad/gl.h>

#include <cstdint>
#include <string>

#include "ridgeline/base/result.h"

namespace ridgeline::gl {

// Once per context, before anything else of this room. `loader` is Context::gl_loader().
Result<void> load(GLADloadfunc loader);

struct Capabilities {
    std::string vendor;
    std::string renderer;
    std::string version;
    bool software = false;  // drawn by the CPU (llvmpipe and the like)
    // Where a draw reaches out of the picture, facing is decided before vertices are moved to the
    // rasteriser's grid of subpixels (Mesa's draw module, which clips and culls for its software renderers).
    // A sliver that turns round in between is left out while its neighbours have moved away from it: a hole
    // of a pixel in a surface that has none.
    bool culls_before_snapping = false;
    bool s3tc = false;            // BC1 textures, linear and sRGB
    float max_anisotropy = 1.0f;  // 1: none
    int max_texture_size_px = 0;
    int max_texture_layers = 0;
    std::uint64_t max_storage_block_bytes = 0;
    int timestamp_bits = 0;  // 0: no GPU times
};

Capabilities query_capabilities();

}  // namespace ridgeline::gl
