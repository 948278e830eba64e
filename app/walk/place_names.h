// Places of a dataset in degrees, quickly: GDAL transforms a lattice of places once, and what lies between is
// interpolated. For showing, not for measuring: within the dataset it is good to a metre or so. Immutable;
// any thread.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "ridgeline/io/terrain_info.h"

namespace ridgeline::app {

class PlaceNames {
  public:
    // Datasets without a reference system, or in one that GDAL cannot turn into degrees, have no such places.
    explicit PlaceNames(const io::TerrainInfo& info);

    // Longitude and latitude in degrees (WGS 84).
    std::optional<glm::dvec2> degrees(const glm::dvec2& east_north_m) const;

  private:
    glm::dvec2 knot(int column, int row) const;

    glm::dvec2 origin_m_{0.0};
    glm::dvec2 spacing_m_{1.0};
    std::vector<glm::dvec2> knots_;  // row by row; empty: none
};

}  // namespace ridgeline::app
