#include "crs_name.h"

#include <ogr_spatialref.h>

#include "gdal_session.h"
#include "placement.h"

namespace ridgeline::raster {
namespace {

bool says_something(const char* name) {
    return name != nullptr && *name != '\0' && !EQUAL(name, "unnamed") && !EQUAL(name, "unknown");
}

std::string text_of(const char* name, const char* otherwise) {
    return says_something(name) ? name : otherwise;
}

std::string authority_of(const OGRSpatialReference& crs) {
    const char* const authority = crs.GetAuthorityName(nullptr);
    const char* const code = crs.GetAuthorityCode(nullptr);
    return authority && code ? std::string(authority) + ":" + code : std::string();
}

// The registered system that is the same but for names, or an empty one. PROJ lists candidates, best first.
OGRSpatialReference registered(const OGRSpatialReference& crs) {
    OGRSpatialReference found;
    int count = 0;
    OGRSpatialReferenceH* const matches = OSRFindMatches(
        OGRSpatialReference::ToHandle(const_cast<OGRSpatialReference*>(&crs)), nullptr, &count, nullptr);
    for (int i = 0; i < count && found.IsEmpty(); ++i)
        if (const auto& match = *OGRSpatialReference::FromHandle(matches[i]); same_plane(crs, match))
            found = match;
    OSRFreeSRSArray(matches);
    return found;
}

std::string described(const OGRSpatialReference& crs) {
    const std::string base =
        text_of(crs.GetAttrValue("GEOGCS"), text_of(crs.GetAttrValue("DATUM"), "").c_str());
    const std::string on_base = base.empty() ? "" : base + " / ";
    int is_north = 0;
    if (const int zone = crs.GetUTMZone(&is_north); zone != 0)
        return on_base + "UTM zone " + std::to_string(zone) + (is_north != 0 ? "N" : "S");
    return on_base + text_of(crs.GetAttrValue("PROJECTION"), "unnamed");
}

}  // namespace

CrsName name_of_crs(const std::string& wkt) {
    if (wkt.empty()) return {"none", {}};
    const GdalMessages quiet;
    OGRSpatialReference crs;
    if (crs.importFromWkt(wkt.c_str()) != OGRERR_NONE) return {"unknown", {}};
    crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    CrsName result{text_of(crs.GetName(), ""), authority_of(crs)};
    if (!result.name.empty() && !result.authority.empty()) return result;
    const OGRSpatialReference match = registered(crs);
    if (result.authority.empty()) result.authority = authority_of(match);
    if (result.name.empty())
        result.name = match.IsEmpty() ? described(crs) : text_of(match.GetName(), "unnamed");
    return result;
}

}  // namespace ridgeline::raster
