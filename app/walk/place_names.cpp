#include "ridgeline/app/walk/place_names.h"

#include <algorithm>
#include <cmath>

#include "ridgeline/base/log.h"
#include "ridgeline/raster/transform.h"

namespace ridgeline::app {
namespace {

// Knots a side: over 160 km, 5 km apart, where a projection's curvature leaves a quarter of a metre.
constexpr int kKnots = 33;

}  // namespace

PlaceNames::PlaceNames(const io::TerrainInfo& info)
    : origin_m_(info.min_east_m(), info.min_north_m()),
      spacing_m_(glm::max(
          glm::dvec2(info.max_east_m() - info.min_east_m(), info.max_north_m() - info.min_north_m()) /
              static_cast<double>(kKnots - 1),
          glm::dvec2(1e-9))) {
    if (info.crs_wkt.empty()) return;
    std::vector<glm::dvec2> places;
    for (int row = 0; row < kKnots; ++row)
        for (int column = 0; column < kKnots; ++column)
            places.push_back(origin_m_ + spacing_m_ * glm::dvec2(column, row));
    auto knots = raster::transform_places(info.crs_wkt, "EPSG:4326", std::move(places));
    if (!knots) {
        spdlog::info("places in degrees: {}", knots.error().message);
        return;
    }
    knots_ = std::move(knots).value();
}

glm::dvec2 PlaceNames::knot(int column, int row) const {
    return knots_[static_cast<std::size_t>(row * kKnots + column)];
}

std::optional<glm::dvec2> PlaceNames::degrees(const glm::dvec2& east_north_m) const {
    if (knots_.empty()) return std::nullopt;
    const glm::dvec2 place = (east_north_m - origin_m_) / spacing_m_;
    const int column = static_cast<int>(std::clamp(std::floor(place.x), 0.0, kKnots - 2.0));
    const int row = static_cast<int>(std::clamp(std::floor(place.y), 0.0, kKnots - 2.0));
    const double u = place.x - column, v = place.y - row;
    const glm::dvec2 south = glm::mix(knot(column, row), knot(column + 1, row), u);
    const glm::dvec2 north = glm::mix(knot(column, row + 1), knot(column + 1, row + 1), u);
    return glm::mix(south, north, v);
}

}  // namespace ridgeline::app
