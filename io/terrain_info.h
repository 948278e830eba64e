// What terrain.json says of a dataset, and the two frames of it: lattice (samples) and world (metres).
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "ridgeline/base/result.h"
#include "ridgeline/io/detail_info.h"
#include "ridgeline/io/grid.h"
#include "ridgeline/io/imagery_info.h"
#include "ridgeline/io/relief.h"

namespace ridgeline::io {

struct TerrainInfo {
    // Raised whenever a reader of the format before would misread the store.
    static constexpr int kFormatVersion = 2;

    std::string crs_wkt;  // empty without georeference
    // World position of the centre of sample (0,0), the north-western one; metres in the CRS.
    double west_m = 0.0;
    double north_m = 0.0;
    double spacing_x_m = 1.0;
    double spacing_y_m = 1.0;
    std::int64_t width = 0;  // samples
    std::int64_t height = 0;
    int tile = 65;  // samples a tile's side, its quads + 1
    ReliefShape relief;
    // height_m = height_offset_m + quanta * quantum_m.
    double quantum_m = 1.0;
    double height_offset_m = 0.0;
    double min_height_m = 0.0;
    double max_height_m = 0.0;
    std::string metric = "geometric";
    // Vertical thresholds of the levels' vertex sets, metres, coarsest first.
    std::vector<double> thresholds_m;
    // Metric "cone": likewise, of the cone's chord times the lattice's spacing at the vertex's scale; else
    // empty.
    std::vector<double> cone_thresholds_m;
    std::int64_t triangles = 0;
    std::int64_t heights_bytes = 0;
    std::int64_t mesh_bytes = 0;
    std::int64_t heights_tiles = 0;
    std::int64_t mesh_tiles = 0;
    std::int64_t invalid_samples = 0;
    std::vector<std::string> sources;  // provenance
    std::vector<std::string> notes;
    std::string generator;
    std::optional<DetailInfo> detail;    // none: a store built before it was foretold
    std::optional<ImageryInfo> imagery;  // none: a store without that layer

    // Not the store's: how many octaves of made ground these samples hold below it (detail::finer_lattice).
    int made_octaves = 0;

    Grid grid() const {
        const auto stored = [this](std::int64_t samples) { return ((samples - 1) >> made_octaves) + 1; };
        return Grid(stored(width), stored(height), tile - 1).finer(made_octaves);
    }
    double height_m(double quanta) const { return height_offset_m + quanta * quantum_m; }
    // World position of a lattice point; the height is the caller's.
    glm::dvec2 world(double column, double row) const {
        return {west_m + column * spacing_x_m, north_m - row * spacing_y_m};
    }
    // The inverse: (column, row).
    glm::dvec2 lattice(double east_m, double northing_m) const {
        return {(east_m - west_m) / spacing_x_m, (north_m - northing_m) / spacing_y_m};
    }
    double min_east_m() const { return west_m; }
    double max_east_m() const { return west_m + static_cast<double>(width - 1) * spacing_x_m; }
    double min_north_m() const { return north_m - static_cast<double>(height - 1) * spacing_y_m; }
    double max_north_m() const { return north_m; }
};

// With a checksum of everything else it says.
std::string to_json(const TerrainInfo& info);
// Errors name what is missing or wrong, be it the checksum; a newer format version is refused with the
// version named.
Result<TerrainInfo> terrain_info_from_json(const std::string& text);

// The file's name in a store, and what it says there.
constexpr const char* kInfoFile = "terrain.json";
Result<TerrainInfo> read_terrain_info(const std::filesystem::path& store);

}  // namespace ridgeline::io
