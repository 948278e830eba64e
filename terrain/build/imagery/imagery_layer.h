// The imagery layer from first row to last byte: for a store that is being built, and for one that stands.
//
// Thread rules: the calling thread reads and writes; the layer's own workers make the tiles meanwhile.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "ridgeline/base/result.h"
#include "ridgeline/base/units.h"
#include "ridgeline/build/imagery/image_encoder.h"
#include "ridgeline/build/imagery/texel_rows.h"
#include "ridgeline/io/pending_directory.h"
#include "ridgeline/io/terrain_info.h"

namespace ridgeline::build {

enum class ImageryStage { tiles, write };

struct LayerOptions {
    int threads = 2;  // that compute, the calling one included
    std::uint64_t memory_bytes = 1_GiB;
    ImageEncoder* encoder = nullptr;  // none: the CPU's
    // Called with rows (tiles) or tiles (write) done and in all; an Error ends the work.
    std::function<Result<void>(ImageryStage, std::int64_t, std::int64_t)> progress;
};

// Writes imagery.bin and imagery.tiles into `directory`; `scratch` exists. Fails, before a row is read, where
// the memory cannot be enough, naming what is.
Result<io::ImageryInfo> build_imagery_layer(TexelRows& rows, const std::filesystem::path& directory,
                                            const std::filesystem::path& scratch,
                                            const LayerOptions& options);

struct AddImageryOptions {
    std::vector<std::string> sources;          // rasters that GDAL reads; later ones cover earlier ones
    std::filesystem::path store;               // that stands
    io::Replace replace = io::Replace::never;  // imagery that it has already
    int jobs = 0;                              // threads that compute; 0: one a core
    std::uint64_t memory_bytes = 1_GiB;
    ImageEncoder* encoder = nullptr;  // none: the CPU's
    std::function<void(ImageryStage, std::int64_t, std::int64_t)> progress;
    const std::atomic<bool>* stop = nullptr;  // raised by whoever wants it to end early, with an Error
};

struct AddImageryReport {
    io::TerrainInfo info;
    double seconds = 0.0;
};

// Gives a store that stands imagery, in one step at the end; whatever fails, or is stopped, changes nothing.
Result<AddImageryReport> add_imagery(const AddImageryOptions& options);

}  // namespace ridgeline::build
