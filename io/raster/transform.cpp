#include "transform.h"

#include <ogr_spatialref.h>

#include <cmath>
#include <memory>

#include "gdal_session.h"

namespace ridgeline::raster {
namespace {

Result<OGRSpatialReference> system_of(const std::string& text) {
    const GdalMessages messages;
    OGRSpatialReference system;
    if (system.SetFromUserInput(text.c_str()) != OGRERR_NONE)
        return Error{text.substr(0, 40) + ": " + messages.why("not a coordinate system that is known here")};
    system.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    return system;
}

std::string shown(const glm::dvec2& place) {
    char text[80];
    std::snprintf(text, sizeof text, "%.12g,%.12g", place.x, place.y);
    return text;
}

}  // namespace

struct PlaceTransform::State {
    std::unique_ptr<OGRCoordinateTransformation> transformation;
};

PlaceTransform::PlaceTransform(std::unique_ptr<State> state) : state_(std::move(state)) {}
PlaceTransform::PlaceTransform(PlaceTransform&&) noexcept = default;
PlaceTransform& PlaceTransform::operator=(PlaceTransform&&) noexcept = default;
PlaceTransform::~PlaceTransform() = default;

Result<PlaceTransform> PlaceTransform::create(const std::string& from, const std::string& to) {
    const auto source = system_of(from);
    if (!source) return source.error();
    const auto target = system_of(to);
    if (!target) return target.error();
    const GdalMessages messages;
    auto state = std::make_unique<State>();
    state->transformation.reset(OGRCreateCoordinateTransformation(&source.value(), &target.value()));
    if (!state->transformation)
        return Error{from + ": " + messages.why("cannot be transformed to the terrain's system")};
    return PlaceTransform(std::move(state));
}

std::optional<glm::dvec2> PlaceTransform::operator()(glm::dvec2 place) const {
    const GdalMessages unheard;
    if (state_->transformation->Transform(1, &place.x, &place.y) == FALSE || !std::isfinite(place.x) ||
        !std::isfinite(place.y))
        return std::nullopt;
    return place;
}

Result<std::vector<glm::dvec2>> transform_places(const std::string& from, const std::string& to,
                                                 std::vector<glm::dvec2> places) {
    const auto transform = PlaceTransform::create(from, to);
    if (!transform) return transform.error();
    for (glm::dvec2& place : places) {
        const auto found = (*transform)(place);
        if (!found)
            return Error{shown(place) + ": not a place of both " + from + " and the terrain's system"};
        place = *found;
    }
    return places;
}

}  // namespace ridgeline::raster
