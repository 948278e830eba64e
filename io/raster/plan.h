// How the sources become one grid: which lie on one lattice and join as they are, and which must be warped.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "height_grid.h"
#include "placement.h"

namespace ridgeline::raster {

struct PlacedGrid {
    std::shared_ptr<HeightGrid> grid;
    Placement placement;
    std::string name;  // for messages: the path, or the first of several
    bool warped = false;
};

struct PlanOptions {
    std::string crs;
    int threads = 1;
};

// One north-up grid on a metric plane of all sources, later ones over earlier ones; adds to `notes`.
Result<PlacedGrid> join(std::vector<PlacedGrid> sources, const PlanOptions& options,
                        std::vector<std::string>& notes);

}  // namespace ridgeline::raster
