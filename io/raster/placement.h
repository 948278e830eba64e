// Where a raster lies: its CRS, made horizontal and metric, and the affine map from its pixels.
//
// Pixel coordinates are GDAL's: (0, 0) is the outer corner of the first sample, whose centre is (½, ½). World
// coordinates are always (east, north), whatever axis order the CRS's authority gives.
#pragma once

#include <ogr_spatialref.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "ridgeline/base/result.h"

class GDALDataset;

namespace ridgeline::raster {

struct Placement {
    std::int64_t width = 0;
    std::int64_t height = 0;
    std::array<double, 6> world_from_pixel{0, 1, 0,
                                           0, 0, -1};  // GDAL's geotransform; metres unless geographic
    OGRSpatialReference crs;                           // horizontal; empty where there is none
    bool georeferenced = false;

    // Rows run due east, columns due south: a lattice that needs no resampling on its plane.
    bool is_north_up() const;
    bool is_geographic() const { return crs.IsGeographic() || crs.IsDerivedGeographic(); }
    double spacing_x() const { return world_from_pixel[1]; }
    double spacing_y() const { return -world_from_pixel[5]; }
};

// Whether rows and columns must be read backwards for the grid to run east and south.
struct Flips {
    bool columns = false;
    bool rows = false;
};

struct PlacedDataset {
    Placement placement;  // of the flipped grid
    Flips flips;
    double height_unit_m = 1.0;  // from the vertical CRS; negative where that counts downwards
    std::vector<std::string> notes;
};

// `assumed_crs` is what the coordinates are taken to be in where the dataset names no CRS (--crs; may be
// empty).
Result<PlacedDataset> place(GDALDataset& dataset, const std::string& assumed_crs);

// Whether coordinates in both mean the same place: axis order and vertical parts do not matter.
bool same_plane(const OGRSpatialReference& a, const OGRSpatialReference& b);

// As WKT 2; empty for an empty CRS.
std::string wkt_of(const OGRSpatialReference& crs);

// A CRS by --crs's argument, with linear unit metre. Fails where it is unknown or not projected.
Result<OGRSpatialReference> metric_crs(const std::string& text);

// The metric CRS in which to build a geographic raster: UTM at its centre, UPS near the poles, an equal-area
// one where it is too wide for UTM, equidistant cylindrical for the whole globe. `name` says which.
struct ChosenCrs {
    std::string name;
    OGRSpatialReference crs;
};
Result<ChosenCrs> choose_metric_crs(const Placement& geographic);

// Metres per unit by the names GDAL's drivers use ("m", "ft", "US survey foot", "ftUS", …); 0: not known.
double metres_per_unit(const std::string& unit);

}  // namespace ridgeline::raster
