// Places of one coordinate system in another, through GDAL: for users who name them in theirs.
// Any thread.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "ridgeline/base/result.h"

namespace ridgeline::raster {

// (east, north) or (longitude, latitude) pairs, in that order whatever the systems' own axes are. `from` and
// `to` are systems as GDAL understands them: "EPSG:4326", a WKT. Fails where either is none, and where a
// place lies beyond what the systems can express.
Result<std::vector<glm::dvec2>> transform_places(const std::string& from, const std::string& to,
                                                 std::vector<glm::dvec2> places);

}  // namespace ridgeline::raster
