// The builder: turns DEMs larger than memory into a terrain store, on every core, deterministically.
//
// Rows stream from the source into a scratch raster on disk; then every block of it is visited twice by jobs,
// once for the vertices' errors, from which the levels' thresholds follow, and once for the tiles. What is
// kept in memory for the whole raster shrinks it 64-fold (build_memory.h adds it up). The thread that calls
// reads and writes all files and works with the others while it waits. A store appears at its place by one
// rename; whatever fails, or is stopped, leaves nothing.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "ridgeline/base/result.h"
#include "ridgeline/base/units.h"
#include "ridgeline/build/imagery/image_encoder.h"
#include "ridgeline/build/vertex_metric.h"
#include "ridgeline/io/store_writer.h"
#include "ridgeline/io/terrain_info.h"

namespace ridgeline::build {

// imagery: the layer of pictures, where there is one, before anything else; read: source into scratch; fill:
// the smooth fill under nodata, where there is any; errors: of all vertices; thresholds: what each level
// keeps; tiles: heights and meshes; write: files in their final order, synced and renamed.
enum class Stage { imagery, read, fill, errors, thresholds, tiles, write };
constexpr int kStages = 7;
const char* stage_name(Stage stage);

// Called from the thread that calls build_terrain, with units done and units in all; errors runs while read
// does.
using Progress = std::function<void(Stage stage, std::int64_t done, std::int64_t total)>;

struct BuildOptions {
    std::vector<std::string> sources;  // rasters that GDAL reads; later ones cover earlier ones
    std::vector<std::string> imagery;  // likewise, pictures; none: a store without imagery
    std::filesystem::path out;         // the store's directory; its parent must exist
    io::Replace replace = io::Replace::never;
    std::string crs;               // as GDAL understands it; empty: keep or choose one
    std::optional<double> nodata;  // stands in for the files' own
    Metric metric = Metric::cone;  // what decides which vertices a level keeps
    int tile = 65;                 // samples a tile's side: 33, 65 or 129
    io::ReliefShape relief;        // must fit the tile
    int jobs = 0;                  // threads that compute, the calling one included; 0: one a core
    // Threads and caches keep within it; a raster that needs more is refused before it is read.
    std::uint64_t memory_bytes = 1_GiB;
    ImageEncoder* encoder = nullptr;  // of imagery; null: the CPU's
    Progress progress;
    const std::atomic<bool>* stop = nullptr;  // raised by whoever wants the build to end early, with an Error
};

struct BuildReport {
    // As terrain.json says it; notes tell which samples were taken as nodata, and why.
    io::TerrainInfo info;
    double seconds = 0.0;
    double stage_seconds[kStages] = {};  // wall time; errors without what ran during read
};

// Builds the store. Errors: unreadable or empty sources, an existing store without Replace::existing, too
// little memory, a full disk, an unwritable directory, a raised stop flag.
Result<BuildReport> build_terrain(const BuildOptions& options);

}  // namespace ridgeline::build
