// What terrain.json says of the imagery layer, and the frame of it: texels of a lattice of its own, which
// need not match the terrain's samples.
//
// Texels are areas: texel (x, y) of the finest level covers [x, x + 1) columns east of the lattice's
// north-western corner, its centre lies half a texel on. The quadtree's cells are texels, so the same Grid
// serves: level l has texels of 2^(finest - l) finest ones a side, a node is kImageryTile of them a side.
// Beyond the lattice's edge nothing is known: tiles repeat the last texels there. Immutable values; any
// thread.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "ridgeline/io/grid.h"

namespace ridgeline::io {

// Content texels a tile's side.
constexpr int kImageryTile = 256;

struct ImageryInfo {
    // Grid's levels hold that many texels a side.
    static constexpr std::int64_t kMaxTexels = std::int64_t{kImageryTile} << (Grid::kMaxLevels - 1);

    // World position of the north-western corner (the outer edge, not the centre) of texel (0, 0); metres in
    // the store's CRS.
    double west_m = 0.0;
    double north_m = 0.0;
    double spacing_x_m = 1.0;
    double spacing_y_m = 1.0;
    std::int64_t width = 0;  // texels
    std::int64_t height = 0;
    std::int64_t tiles = 0;
    std::int64_t bytes = 0;
    std::vector<std::string> sources;  // provenance
    std::vector<std::string> notes;
    std::string generator;

    Grid grid() const { return Grid(width + 1, height + 1, kImageryTile); }
    // World position of a place in texels, counted from the corner: (0.5, 0.5) is the first texel's centre.
    glm::dvec2 world(double column, double row) const {
        return {west_m + column * spacing_x_m, north_m - row * spacing_y_m};
    }
    // The inverse: (column, row).
    glm::dvec2 texel(double east_m, double northing_m) const {
        return {(east_m - west_m) / spacing_x_m, (north_m - northing_m) / spacing_y_m};
    }
    // The lattice's outer edges. Beyond them there is no imagery, whatever a tile repeats there.
    double east_m() const { return west_m + static_cast<double>(width) * spacing_x_m; }
    double south_m() const { return north_m - static_cast<double>(height) * spacing_y_m; }
};

}  // namespace ridgeline::io
