// Conventions: GDAL's raster data model (geotransforms are of outer pixel corners: drivers have applied
// AREA_OR_POINT already), OGC 01-009 / ISO 19111 for what a CRS may be. UTM and UPS limits: DMA TM 8358.2.
#include "placement.h"

#include <gdal_priv.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "gdal_session.h"

namespace ridgeline::raster {
namespace {

// A lattice counts as straight, and two as one, while no sample is off by more than this share of a spacing.
constexpr double kLatticeTolerance = 0.01;
// Beyond 84° north and 80° south UTM ends and UPS begins.
constexpr double kUtmNorth_deg = 84.0;
constexpr double kUtmSouth_deg = -80.0;
// Half-widths in longitude up to which transverse Mercator's scale stays within about 1.5 %, and up to which
// an azimuthal projection is sensible at all.
constexpr double kUtmHalfWidth_deg = 10.0;
constexpr double kAzimuthalHalfWidth_deg = 50.0;

bool is_nowhere(const std::array<double, 6>& t) {
    return t[0] == 0 && t[1] == 1 && t[2] == 0 && t[3] == 0 && t[4] == 0 && std::abs(t[5]) == 1;
}

bool is_usable(const std::array<double, 6>& t) {
    const double area = t[1] * t[5] - t[2] * t[4];
    return std::all_of(t.begin(), t.end(), [](double v) { return std::isfinite(v); }) && area != 0;
}

std::array<double, 6> pixel_units(std::int64_t height) {
    return {-0.5, 1, 0, static_cast<double>(height) - 0.5, 0, -1};
}

// Ground control points by an affine map: exact where they allow it, else the best fit, which is said.
bool place_by_control_points(GDALDataset& dataset, PlacedDataset& placed) {
    const int count = dataset.GetGCPCount();
    const OGRSpatialReference* crs = dataset.GetGCPSpatialRef();
    if (count < 3 || crs == nullptr) return false;
    double* transform = placed.placement.world_from_pixel.data();
    if (!GDALGCPsToGeoTransform(count, dataset.GetGCPs(), transform, FALSE)) {
        if (!GDALGCPsToGeoTransform(count, dataset.GetGCPs(), transform, TRUE)) return false;
        placed.notes.push_back("placed by the affine map that fits its " + std::to_string(count) +
                               " ground control points best");
    }
    placed.placement.crs = *crs;
    return true;
}

bool read_placement(GDALDataset& dataset, PlacedDataset& placed) {
    Placement& placement = placed.placement;
    if (dataset.GetGeoTransform(placement.world_from_pixel.data()) != CE_None)
        return place_by_control_points(dataset, placed);
    const OGRSpatialReference* crs = dataset.GetSpatialRef();
    if (crs != nullptr) placement.crs = *crs;
    return crs != nullptr || !is_nowhere(placement.world_from_pixel);
}

// Reads backwards along the axes that run the wrong way, so that only real rotations remain.
void straighten(PlacedDataset& placed) {
    std::array<double, 6>& t = placed.placement.world_from_pixel;
    placed.flips = {.columns = t[1]<0, .rows = t[5]> 0};
    const auto reverse_axis = [&t](int first, std::int64_t count) {
        for (const int axis : {first, first + 3}) {
            t[static_cast<std::size_t>(axis < 3 ? 0 : 3)] +=
                t[static_cast<std::size_t>(axis)] * static_cast<double>(count);
            t[static_cast<std::size_t>(axis)] *= -1;
        }
    };
    if (placed.flips.columns) reverse_axis(1, placed.placement.width);
    if (placed.flips.rows) reverse_axis(2, placed.placement.height);
}

void take_vertical_unit(PlacedDataset& placed) {
    const OGRSpatialReference& crs = placed.placement.crs;
    if (!crs.IsCompound() && !crs.IsVertical()) return;
    const char* unit = nullptr;
    placed.height_unit_m = crs.GetTargetLinearUnits("VERT_CS", &unit);
    if (!(placed.height_unit_m > 0)) placed.height_unit_m = 1.0;
    OGRAxisOrientation orientation = OAO_Up;
    if (crs.GetAxis("VERT_CS", 0, &orientation) && orientation == OAO_Down) {
        placed.height_unit_m *= -1;
        placed.notes.push_back("the vertical CRS counts downwards: depths are turned to heights");
    }
    if (const char* name = crs.GetAttrValue("VERT_CS"))
        placed.notes.push_back(std::string("heights refer to ") + name);
}

void drop_vertical_part(OGRSpatialReference& crs) {
    if (crs.IsCompound()) crs.StripVertical();
    if (crs.GetAxesCount() == 3) crs.DemoteTo2D(nullptr);
}

// Feet on the ground become metres, in the coordinates and in the CRS alike: nothing is resampled.
void make_metric(PlacedDataset& placed) {
    Placement& placement = placed.placement;
    if (placement.crs.IsEmpty() || placement.is_geographic()) return;
    const char* unit = nullptr;
    const double metres = placement.crs.GetLinearUnits(&unit);
    if (!(metres > 0) || std::abs(metres - 1.0) < 1e-12) return;
    placed.notes.push_back(std::string("coordinates in ") + (unit ? unit : "another unit") +
                           " are turned to metres (1 unit = " + std::to_string(metres) + " m)");
    for (double& value : placement.world_from_pixel) value *= metres;
    placement.crs.SetLinearUnitsAndUpdateParameters(SRS_UL_METER, 1.0);
}

// Files without a CRS often hold degrees: told by coordinates that fit the globe and steps far under a
// degree.
bool looks_like_degrees(const Placement& placement) {
    const std::array<double, 6>& t = placement.world_from_pixel;
    const double east = t[0] + t[1] * static_cast<double>(placement.width);
    const double south = t[3] + t[5] * static_cast<double>(placement.height);
    const bool on_globe = std::min(t[0], east) >= -181 && std::max(t[0], east) <= 361 &&
                          std::min(t[3], south) >= -91 && std::max(t[3], south) <= 91;
    return on_globe && std::abs(t[1]) < 0.1 && std::abs(t[5]) < 0.1;
}

Result<void> assume_crs(PlacedDataset& placed, const std::string& assumed_crs) {
    OGRSpatialReference& crs = placed.placement.crs;
    if (!crs.IsEmpty()) return {};
    if (looks_like_degrees(placed.placement)) {
        crs.SetFromUserInput("EPSG:4326");
        crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
        placed.notes.push_back("names no CRS; its coordinates look like degrees and are taken as WGS 84");
    } else if (!assumed_crs.empty()) {
        auto named = metric_crs(assumed_crs);
        if (!named) return named.error();
        crs = *named;
        placed.notes.push_back("names no CRS; its coordinates are taken to be in " + assumed_crs);
    } else {
        placed.notes.push_back("names no CRS; its coordinates are taken as metres (--crs says otherwise)");
    }
    return {};
}

struct LonLat {
    double longitude_deg = 0;
    double latitude_deg = 0;
    double half_width_deg = 0;
};

// Centre and half-width of a geographic raster, in degrees from Greenwich on its own datum.
LonLat geographic_extent(const Placement& placement) {
    const std::array<double, 6>& t = placement.world_from_pixel;
    const double columns = static_cast<double>(placement.width);
    const double rows = static_cast<double>(placement.height);
    const double degrees = placement.crs.GetAngularUnits() * 180.0 / M_PI;
    const double longitude =
        (t[0] + t[1] * columns / 2 + t[2] * rows / 2) * degrees + placement.crs.GetPrimeMeridian();
    const double latitude = (t[3] + t[4] * columns / 2 + t[5] * rows / 2) * degrees;
    const double width = (std::abs(t[1]) * columns + std::abs(t[2]) * rows) * degrees;
    return {std::remainder(longitude, 360.0), latitude, width / 2};
}

// On the raster's own datum, so that no datum shift is applied to it.
OGRSpatialReference on_datum_of(const OGRSpatialReference& geographic, const std::string& name) {
    OGRSpatialReference crs;
    crs.SetProjCS(name.c_str());
    crs.CopyGeogCSFrom(&geographic);
    crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    return crs;
}

bool is_wgs84(const OGRSpatialReference& crs) {
    OGRSpatialReference wgs84;
    wgs84.SetFromUserInput("EPSG:4326");
    return same_plane(crs, wgs84);
}

ChosenCrs utm(const OGRSpatialReference& geographic, const LonLat& centre) {
    const int zone =
        std::clamp(static_cast<int>(std::floor((centre.longitude_deg + 180.0) / 6.0)) + 1, 1, 60);
    const bool north = centre.latitude_deg >= 0;
    ChosenCrs chosen;
    chosen.name = "UTM zone " + std::to_string(zone) + (north ? "N" : "S");
    if (is_wgs84(geographic)) {
        chosen.crs.importFromEPSG((north ? 32600 : 32700) + zone);
        chosen.crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
        return chosen;
    }
    const char* datum = geographic.GetAttrValue("GEOGCS");
    chosen.crs = on_datum_of(geographic, std::string(datum ? datum : "unknown") + " / " + chosen.name);
    chosen.crs.SetUTM(zone, north);
    return chosen;
}

ChosenCrs polar(const OGRSpatialReference& geographic, const LonLat& centre) {
    const bool north = centre.latitude_deg > 0;
    ChosenCrs chosen;
    chosen.name = north ? "polar stereographic (north)" : "polar stereographic (south)";
    chosen.crs = on_datum_of(geographic, chosen.name);
    // UPS: scale 0.994 at the pole, false origin at 2 000 km.
    chosen.crs.SetPS(north ? 90.0 : -90.0, 0.0, 0.994, 2e6, 2e6);
    return chosen;
}

ChosenCrs equal_area(const OGRSpatialReference& geographic, const LonLat& centre) {
    ChosenCrs chosen;
    chosen.name = "Lambert azimuthal equal-area";
    chosen.crs = on_datum_of(geographic, chosen.name);
    chosen.crs.SetLAEA(std::round(centre.latitude_deg), std::round(centre.longitude_deg), 0.0, 0.0);
    return chosen;
}

ChosenCrs equidistant(const OGRSpatialReference& geographic, const LonLat& centre) {
    ChosenCrs chosen;
    chosen.name = "equidistant cylindrical";
    chosen.crs = on_datum_of(geographic, chosen.name);
    chosen.crs.SetEquirectangular2(0.0, std::round(centre.longitude_deg), 0.0, 0.0, 0.0);
    return chosen;
}

constexpr double kFoot = 0.3048;
constexpr double kSurveyFoot = 1200.0 / 3937.0;

struct NamedUnit {
    const char* name;  // small letters and digits only
    double metres;
};
constexpr NamedUnit kUnits[] = {
    {"m", 1.0},
    {"metre", 1.0},
    {"metres", 1.0},
    {"meter", 1.0},
    {"meters", 1.0},
    {"metersm", 1.0},
    {"dm", 0.1},
    {"decimetre", 0.1},
    {"decimeter", 0.1},
    {"decimeters", 0.1},
    {"cm", 0.01},
    {"centimetre", 0.01},
    {"centimeter", 0.01},
    {"centimeters", 0.01},
    {"mm", 0.001},
    {"millimetre", 0.001},
    {"millimeter", 0.001},
    {"km", 1000.0},
    {"kilometre", 1000.0},
    {"kilometer", 1000.0},
    {"ft", kFoot},
    {"foot", kFoot},
    {"feet", kFoot},
    {"internationalfoot", kFoot},
    {"usft", kSurveyFoot},
    {"ftus", kSurveyFoot},
    {"footus", kSurveyFoot},
    {"ussurveyfoot", kSurveyFoot},
    {"ussurveyfeet", kSurveyFoot},
    {"surveyfoot", kSurveyFoot},
    {"surveyfeet", kSurveyFoot},
    {"yd", 3 * kFoot},
    {"yard", 3 * kFoot},
    {"yards", 3 * kFoot},
    {"fathom", 6 * kFoot},
    {"fathoms", 6 * kFoot},
};

}  // namespace

bool Placement::is_north_up() const {
    const std::array<double, 6>& t = world_from_pixel;
    const double drift_x = std::abs(t[2]) * static_cast<double>(height);
    const double drift_y = std::abs(t[4]) * static_cast<double>(width);
    return drift_x <= kLatticeTolerance * std::abs(t[1]) && drift_y <= kLatticeTolerance * std::abs(t[5]);
}

Result<PlacedDataset> place(GDALDataset& dataset, const std::string& assumed_crs) {
    PlacedDataset placed;
    Placement& placement = placed.placement;
    placement.width = dataset.GetRasterXSize();
    placement.height = dataset.GetRasterYSize();
    placement.georeferenced = read_placement(dataset, placed);
    if (placement.georeferenced && !is_usable(placement.world_from_pixel)) {
        placement.georeferenced = false;
        placed.notes.push_back("its georeference is degenerate and left aside");
    }
    if (!placement.georeferenced) {
        placement.crs.Clear();
        placement.world_from_pixel = pixel_units(placement.height);
        placed.notes.push_back("no georeference: built in pixel units, one unit a pixel");
        return placed;
    }
    if (placement.crs.IsGeocentric())
        return Error{"its coordinates are geocentric, which is no plane to build on"};
    placement.crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    take_vertical_unit(placed);
    drop_vertical_part(placement.crs);
    RIDGELINE_TRY(assume_crs(placed, assumed_crs));
    make_metric(placed);
    straighten(placed);
    return placed;
}

bool same_plane(const OGRSpatialReference& a, const OGRSpatialReference& b) {
    if (a.IsEmpty() || b.IsEmpty()) return a.IsEmpty() && b.IsEmpty();
    const GdalMessages quiet;
    const char* const options[] = {"IGNORE_DATA_AXIS_TO_SRS_AXIS_MAPPING=YES", "CRITERION=EQUIVALENT",
                                   nullptr};
    return a.IsSame(&b, options) != 0;
}

std::string wkt_of(const OGRSpatialReference& crs) {
    if (crs.IsEmpty()) return {};
    char* text = nullptr;
    const char* const options[] = {"FORMAT=WKT2_2019", nullptr};
    crs.exportToWkt(&text, options);
    std::string wkt = text ? text : "";
    CPLFree(text);
    return wkt;
}

Result<OGRSpatialReference> metric_crs(const std::string& text) {
    const GdalMessages messages;
    OGRSpatialReference crs;
    if (crs.SetFromUserInput(text.c_str()) != OGRERR_NONE)
        return Error{"--crs " + text + ": " + messages.why("not a CRS that PROJ knows")};
    drop_vertical_part(crs);
    if (!crs.IsProjected())
        return Error{"--crs " + text + ": not a projected CRS; a store is built on a metric plane"};
    crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    if (std::abs(crs.GetLinearUnits() - 1.0) > 1e-12)
        crs.SetLinearUnitsAndUpdateParameters(SRS_UL_METER, 1.0);
    return crs;
}

Result<ChosenCrs> choose_metric_crs(const Placement& geographic) {
    const LonLat extent = geographic_extent(geographic);
    std::unique_ptr<OGRSpatialReference> base(geographic.crs.CloneGeogCS());
    if (!base) return Error{"its CRS has no geographic base; choose one to build in with --crs"};
    if (extent.half_width_deg > kAzimuthalHalfWidth_deg && std::abs(extent.latitude_deg) < 45)
        return equidistant(*base, extent);
    if (extent.latitude_deg > kUtmNorth_deg || extent.latitude_deg < kUtmSouth_deg ||
        extent.half_width_deg > kAzimuthalHalfWidth_deg)
        return polar(*base, extent);
    if (extent.half_width_deg > kUtmHalfWidth_deg) return equal_area(*base, extent);
    return utm(*base, extent);
}

double metres_per_unit(const std::string& unit) {
    std::string name;
    for (const char c : unit)
        if (std::isalnum(static_cast<unsigned char>(c)))
            name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    for (const NamedUnit& known : kUnits)
        if (name == known.name) return known.metres;
    return 0.0;
}

}  // namespace ridgeline::raster
