// Places of one coordinate system in another, through GDAL: for users who name them in theirs.
// A PlaceTransform belongs to one thread at a time.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ridgeline/base/result.h"

namespace ridgeline::raster {

// From one system to another, for places one at a time. Systems and the order of coordinates as below.
class PlaceTransform {
  public:
    static Result<PlaceTransform> create(const std::string& from, const std::string& to);
    PlaceTransform(PlaceTransform&&) noexcept;
    PlaceTransform& operator=(PlaceTransform&&) noexcept;
    ~PlaceTransform();

    // None beyond what the systems can express.
    std::optional<glm::dvec2> operator()(glm::dvec2 place) const;

  private:
    struct State;
    explicit PlaceTransform(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

// (east, north) or (longitude, latitude) pairs, in that order whatever the systems' own axes are. `from` and
// `to` are systems as GDAL understands them: "EPSG:4326", a WKT. Fails where either is none, and where a
// place lies beyond what the systems can express.
Result<std::vector<glm::dvec2>> transform_places(const std::string& from, const std::string& to,
                                                 std::vector<glm::dvec2> places);

}  // namespace ridgeline::raster
