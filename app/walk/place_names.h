// Places of a dataset in degrees, for those who do not think in its reference system. Render thread.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "ridgeline/io/terrain_info.h"
#include "ridgeline/raster/transform.h"

namespace ridgeline::app {

class PlaceNames {
  public:
    // Datasets without a reference system, or in one that GDAL cannot turn into degrees, have no such places.
    explicit PlaceNames(const io::TerrainInfo& info);

    // Longitude and latitude in degrees (WGS 84).
    std::optional<glm::dvec2> degrees(const glm::dvec2& east_north_m) const;

  private:
    std::optional<raster::PlaceTransform> to_degrees_;
};

}  // namespace ridgeline::app
