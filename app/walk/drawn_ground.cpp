#include "ridgeline/app/walk/drawn_ground.h"

namespace ridgeline::app {

Box terrain_box(const io::TerrainInfo& info, double exaggeration) {
    const auto drawn = [&](double height_m) {
        return info.height_offset_m + (height_m - info.height_offset_m) * exaggeration;
    };
    return {{info.min_east_m(), info.min_north_m(), drawn(info.min_height_m)},
            {info.max_east_m(), info.max_north_m(), drawn(info.max_height_m)}};
}

DrawnGround::DrawnGround(const io::Store& store, double exaggeration)
    : surface_(store, {.cached_chunks = 256}),
      offset_m_(store.info().height_offset_m),
      exaggeration_(exaggeration) {}

platform::GroundFunction DrawnGround::function() {
    return [this](const glm::dvec2& place) { return height(place); };
}

std::optional<double> DrawnGround::height(const glm::dvec2& place) {
    const auto height_m = surface_.height(place.x, place.y);
    if (!height_m) {
        if (!failure_) failure_ = height_m.error();
        return std::nullopt;
    }
    if (!*height_m) return std::nullopt;
    return offset_m_ + (**height_m - offset_m_) * exaggeration_;
}

}  // namespace ridgeline::app
