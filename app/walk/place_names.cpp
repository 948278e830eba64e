#include "ridgeline/app/walk/place_names.h"

#include <utility>

#include "ridgeline/base/log.h"

namespace ridgeline::app {

PlaceNames::PlaceNames(const io::TerrainInfo& info) {
    if (info.crs_wkt.empty()) return;
    auto transform = raster::PlaceTransform::create(info.crs_wkt, "EPSG:4326");
    if (transform)
        to_degrees_ = std::move(transform).value();
    else
        log_line(LogLevel::info, "places in degrees: " + transform.error().message);
}

std::optional<glm::dvec2> PlaceNames::degrees(const glm::dvec2& east_north_m) const {
    return to_degrees_ ? (*to_degrees_)(east_north_m) : std::nullopt;
}

}  // namespace ridgeline::app
