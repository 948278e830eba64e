// Small rasters for tests of io/raster: written through GDAL into a folder that goes with the test.
#pragma once

#include <doctest/doctest.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "ridgeline/raster/dem_source.h"

namespace ridgeline::raster {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

class TempFolder {
  public:
    TempFolder() {
        path_ = std::filesystem::temp_directory_path() / "ridgeline-XXXXXX";
        std::string name = path_.string();
        REQUIRE(mkdtemp(name.data()) != nullptr);
        path_ = name;
    }
    ~TempFolder() { std::filesystem::remove_all(path_); }
    TempFolder(const TempFolder&) = delete;
    TempFolder& operator=(const TempFolder&) = delete;
    std::string file(const std::string& name) const { return (path_ / name).string(); }

  private:
    std::filesystem::path path_;
};

// A raster to write; values row by row, the file's first row first, in stored units.
struct Spec {
    int width = 4;
    int height = 3;
    std::vector<double> values = {};
    GDALDataType type = GDT_Int16;
    std::vector<std::string> creation = {};
    std::optional<std::array<double, 6>> transform = std::array<double, 6>{500000, 10, 0, 5200000, 0, -10};
    std::string crs = "EPSG:32633";
    std::optional<double> nodata = {};
    double scale = 1.0;
    double offset = 0.0;
    std::string unit = {};
    std::vector<double> mask = {};  // 0 marks nodata
    bool point = false;             // AREA_OR_POINT=Point
};

inline std::vector<double> ramp(int count, double first = 0.0, double step = 1.0) {
    std::vector<double> values;
    for (int i = 0; i < count; ++i) values.push_back(first + step * i);
    return values;
}

inline std::vector<double> random_values(int count, double low, double high, unsigned seed) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> distribution(low, high);
    std::vector<double> values;
    for (int i = 0; i < count; ++i) values.push_back(std::floor(distribution(generator)));
    return values;
}

inline void write_band(GDALRasterBand& band, const std::vector<double>& values) {
    REQUIRE(values.size() == static_cast<std::size_t>(band.GetXSize()) * band.GetYSize());
    std::vector<double> copy = values;
    REQUIRE(band.RasterIO(GF_Write, 0, 0, band.GetXSize(), band.GetYSize(), copy.data(), band.GetXSize(),
                          band.GetYSize(), GDT_Float64, 0, 0, nullptr) == CE_None);
}

inline std::string write_raster(const std::string& path, const Spec& spec) {
    GDALAllRegister();
    CPLSetThreadLocalConfigOption("GDAL_TIFF_INTERNAL_MASK", "YES");
    CPLStringList options;
    for (const std::string& option : spec.creation) options.AddString(option.c_str());
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
    GDALDatasetUniquePtr dataset(
        driver->Create(path.c_str(), spec.width, spec.height, 1, spec.type, options.List()));
    REQUIRE(dataset);
    if (spec.point) dataset->SetMetadataItem("AREA_OR_POINT", "Point");
    if (spec.transform) {
        std::array<double, 6> transform = *spec.transform;
        dataset->SetGeoTransform(transform.data());
    }
    if (!spec.crs.empty()) {
        OGRSpatialReference crs;
        REQUIRE(crs.SetFromUserInput(spec.crs.c_str()) == OGRERR_NONE);
        crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
        dataset->SetSpatialRef(&crs);
    }
    GDALRasterBand& band = *dataset->GetRasterBand(1);
    if (spec.nodata) band.SetNoDataValue(*spec.nodata);
    if (spec.scale != 1.0) band.SetScale(spec.scale);
    if (spec.offset != 0.0) band.SetOffset(spec.offset);
    if (!spec.unit.empty()) band.SetUnitType(spec.unit.c_str());
    if (!spec.mask.empty()) {
        REQUIRE(dataset->CreateMaskBand(GMF_PER_DATASET) == CE_None);
        write_band(*band.GetMaskBand(), spec.mask);
    }
    if (!spec.values.empty()) write_band(band, spec.values);
    return path;
}

inline DemSource open_ok(const std::vector<std::string>& paths, const RasterOptions& options = {}) {
    auto source = DemSource::open(paths, options);
    REQUIRE_MESSAGE(source.ok(), (source.ok() ? "" : source.error().message));
    return std::move(*source);
}

// All heights, read in bands of `band_rows`.
inline std::vector<double> all_heights(DemSource& source, std::int64_t band_rows = 1000) {
    const RasterInfo& info = source.info();
    std::vector<double> heights(static_cast<std::size_t>(info.width * info.height));
    for (std::int64_t row = 0; row < info.height; row += band_rows) {
        const std::int64_t rows = std::min(band_rows, info.height - row);
        const auto band = std::span(heights).subspan(static_cast<std::size_t>(row * info.width),
                                                     static_cast<std::size_t>(rows * info.width));
        const auto read = source.read_rows(row, rows, band);
        REQUIRE_MESSAGE(read.ok(), (read.ok() ? "" : read.error().message));
    }
    return heights;
}

inline std::vector<std::int32_t> all_steps(DemSource& source) {
    const RasterInfo& info = source.info();
    std::vector<std::int32_t> steps(static_cast<std::size_t>(info.width * info.height));
    REQUIRE(source.read_steps(0, info.height, steps).ok());
    return steps;
}

inline bool same_heights(const std::vector<double>& a, const std::vector<double>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

inline bool says(const std::vector<std::string>& lines, const std::string& words) {
    return std::any_of(lines.begin(), lines.end(),
                       [&words](const std::string& line) { return line.find(words) != std::string::npos; });
}

}  // namespace ridgeline::raster
