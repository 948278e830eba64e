// Suite `imagery`: the encoders of `build --imagery`, on the CPU and on the GPU, over the same texels.
//
// Variants imagery/cpu and imagery/gpu, the latter where there is OpenGL. Metrics: mpixel_per_s (source
// pixels from the decoded raster in memory to the finished layer on disk, all mips in, on all threads),
// encode_mpixel_per_s (blocks of the finest level alone, one thread asking), psnr_db (of these, over opaque
// texels), bytes_per_pixel (the layer's, a source pixel), layer_bytes, and source_bytes (the rasters' files,
// where all of them are files and the whole of them was encoded).
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "ridgeline/app/bench/figures.h"
#include "ridgeline/base/result.h"
#include "ridgeline/build/imagery/image_encoder.h"

namespace ridgeline::app {

struct NamedEncoder {
    std::string name;
    build::ImageEncoder* encoder = nullptr;
};

struct ImagerySuiteOptions {
    std::filesystem::path scratch;  // an existing folder; the layers are built in it and removed
    // What is decoded, northmost rows first: 4 bytes of memory each.
    std::int64_t most_texels = std::int64_t{1} << 27;
    int threads = 2;
    std::function<void(std::int64_t, std::int64_t)> progress;  // steps done, and in all; may be empty
};

struct ImagerySuiteSource {
    std::filesystem::path store;
    std::vector<std::string> rasters;  // none: what the store's imagery was built from
};

// Errors: neither rasters nor imagery in the store; what build_imagery_layer may meet.
Result<Figures> run_imagery_suite(const ImagerySuiteSource& source, const std::vector<NamedEncoder>& encoders,
                                  const ImagerySuiteOptions& options);

// The same of any texels, without source_bytes.
Result<Figures> compare_encoders(build::TexelRows& source, const std::vector<NamedEncoder>& encoders,
                                 const ImagerySuiteOptions& options);

}  // namespace ridgeline::app
