#include "ridgeline/raster/crs_name.h"

#include <cpl_conv.h>
#include <doctest/doctest.h>
#include <ogr_spatialref.h>

using namespace ridgeline::raster;

namespace {

std::string wkt_of(const OGRSpatialReference& crs) {
    char* text = nullptr;
    const char* const options[] = {"FORMAT=WKT2_2019", nullptr};
    crs.exportToWkt(&text, options);
    const std::string wkt = text;
    CPLFree(text);
    return wkt;
}

// As drivers of plain formats make them: a zone on a datum, and nothing said of names.
std::string unnamed_utm(int zone, int north) {
    OGRSpatialReference crs;
    crs.SetProjCS("unnamed");
    crs.SetUTM(zone, north);
    crs.SetWellKnownGeogCS("WGS84");
    return wkt_of(crs);
}

}  // namespace

TEST_CASE("a registered system goes by its name and number") {
    OGRSpatialReference crs;
    REQUIRE(crs.importFromEPSG(32633) == OGRERR_NONE);
    const CrsName name = name_of_crs(wkt_of(crs));
    CHECK(name.name == "WGS 84 / UTM zone 33N");
    CHECK(name.authority == "EPSG:32633");
}

TEST_CASE("an unnamed system that equals a registered one goes by that") {
    const CrsName north = name_of_crs(unnamed_utm(10, TRUE));
    CHECK(north.name == "WGS 84 / UTM zone 10N");
    CHECK(north.authority == "EPSG:32610");
    CHECK(name_of_crs(unnamed_utm(10, FALSE)).authority == "EPSG:32710");
}

TEST_CASE("an unnamed system of its own is described, and has no number") {
    OGRSpatialReference crs;
    crs.SetProjCS("unnamed");
    crs.SetWellKnownGeogCS("WGS84");
    crs.SetLAEA(47.0, 11.0, 12.0, 34.0);
    const CrsName name = name_of_crs(wkt_of(crs));
    CHECK(name.name == "WGS 84 / Lambert_Azimuthal_Equal_Area");
    CHECK(name.authority.empty());
}

TEST_CASE("no system and nonsense have their words") {
    CHECK(name_of_crs("").name == "none");
    CHECK(name_of_crs("PROJCS[").name == "unknown");
}
