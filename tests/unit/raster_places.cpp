#include "unit/raster_fixture.h"

using namespace ridgeline::raster;

namespace {

std::vector<double> flipped_rows(const std::vector<double>& values, int width) {
    std::vector<double> flipped;
    for (auto row = values.end(); row != values.begin();) {
        row -= width;
        flipped.insert(flipped.end(), row, row + width);
    }
    return flipped;
}

}  // namespace

TEST_CASE("samples lie at pixel centres, north-up, square or not") {
    const TempFolder folder;
    Spec spec{.values = ramp(12), .transform = std::array<double, 6>{500000, 10, 0, 5200000, 0, -25}};
    DemSource source = open_ok({write_raster(folder.file("a.tif"), spec)});
    const RasterInfo& info = source.info();
    CHECK(info.width == 4);
    CHECK(info.height == 3);
    CHECK(info.spacing_x_m == 10.0);
    CHECK(info.spacing_y_m == 25.0);
    CHECK(info.west_east_m == 500005.0);
    CHECK(info.north_north_m == 5199987.5);
    CHECK(info.georeferenced);
    CHECK_FALSE(info.warped);
    CHECK(info.crs_wkt.find("32633") != std::string::npos);
    CHECK(info.driver == "GTiff");
    CHECK(info.data_type == "Int16");
}

TEST_CASE("AREA_OR_POINT=Point moves nothing: GDAL's transform is of outer corners either way") {
    const TempFolder folder;
    Spec spec{.values = ramp(12), .point = true};
    DemSource source = open_ok({write_raster(folder.file("a.tif"), spec)});
    CHECK(source.info().west_east_m == 500005.0);
    CHECK(source.info().north_north_m == 5199995.0);
}

TEST_CASE("south-up and west-left files are read the right way round, not resampled") {
    const TempFolder folder;
    Spec spec{.values = ramp(12), .transform = std::array<double, 6>{500000, 10, 0, 5199970, 0, 10}};
    DemSource source = open_ok({write_raster(folder.file("a.tif"), spec)});
    CHECK_FALSE(source.info().warped);
    CHECK(source.info().north_north_m == 5199995.0);
    CHECK(same_heights(all_heights(source), flipped_rows(spec.values, 4)));
    CHECK(same_heights(all_heights(source, 1), flipped_rows(spec.values, 4)));

    spec.transform = std::array<double, 6>{500040, -10, 0, 5200000, 0, -10};
    DemSource mirrored = open_ok({write_raster(folder.file("b.tif"), spec)});
    CHECK_FALSE(mirrored.info().warped);
    CHECK(mirrored.info().west_east_m == 500005.0);
    CHECK(same_heights(all_heights(mirrored), {3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8}));
}

TEST_CASE("without georeference a pixel is a unit and the last row is north 0") {
    const TempFolder folder;
    DemSource source = open_ok(
        {write_raster(folder.file("a.tif"), {.values = ramp(12), .transform = std::nullopt, .crs = ""})});
    const RasterInfo& info = source.info();
    CHECK_FALSE(info.georeferenced);
    CHECK(info.crs_wkt.empty());
    CHECK(info.spacing_x_m == 1.0);
    CHECK(info.west_east_m == 0.0);
    CHECK(info.north_north_m == 2.0);
    CHECK(says(info.notes, "no georeference"));
}

TEST_CASE("a single row, column or sample is doubled, one spacing on") {
    const TempFolder folder;
    for (const auto& size : {std::pair{5, 1}, std::pair{1, 5}, std::pair{1, 1}}) {
        const int width = size.first, height = size.second;
        CAPTURE(width);
        CAPTURE(height);
        Spec spec{.width = width, .height = height, .values = ramp(width * height, 40)};
        DemSource source = open_ok({write_raster(folder.file("a.tif"), spec)});
        const RasterInfo& info = source.info();
        REQUIRE(info.width == std::max(2, width));
        REQUIRE(info.height == std::max(2, height));
        CHECK(info.west_east_m == 500005.0);
        CHECK(info.north_north_m == 5199995.0);
        for (const std::int64_t band : {1, 2, 9}) {
            const auto heights = all_heights(source, band);
            for (int row = 0; row < info.height; ++row)
                for (int column = 0; column < info.width; ++column) {
                    const int from = std::min(row, height - 1) * width + std::min(column, width - 1);
                    CHECK(heights[static_cast<std::size_t>(row * info.width + column)] ==
                          spec.values[static_cast<std::size_t>(from)]);
                }
        }
        CHECK(all_steps(source).back() == spec.values.back());
    }
}

TEST_CASE("a projected CRS in feet becomes metric without resampling") {
    const TempFolder folder;
    Spec spec{.values = ramp(12),
              .transform = std::array<double, 6>{6000000, 100, 0, 2000000, 0, -100},
              .crs = "EPSG:2227"};
    DemSource source = open_ok({write_raster(folder.file("a.tif"), spec)});
    const RasterInfo& info = source.info();
    const double foot = 1200.0 / 3937.0;
    CHECK_FALSE(info.warped);
    CHECK(info.spacing_x_m == doctest::Approx(100 * foot).epsilon(1e-12));
    CHECK(info.west_east_m == doctest::Approx(6000050 * foot).epsilon(1e-12));
    CHECK(says(info.notes, "turned to metres"));
    CHECK(same_heights(all_heights(source), ramp(12)));

    // The metric CRS says the same places as the one in feet.
    OGRSpatialReference feet;
    OGRSpatialReference metres;
    feet.SetFromUserInput("EPSG:2227");
    REQUIRE(metres.SetFromUserInput(info.crs_wkt.c_str()) == OGRERR_NONE);
    feet.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    metres.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    const std::unique_ptr<OGRCoordinateTransformation> transform(
        OGRCreateCoordinateTransformation(&feet, &metres));
    double x = 6000050;
    double y = 1999950;
    REQUIRE(transform->Transform(1, &x, &y));
    CHECK(x == doctest::Approx(info.west_east_m).epsilon(1e-9));
    CHECK(y == doctest::Approx(info.north_north_m).epsilon(1e-9));
}

TEST_CASE("heights are in the unit of the vertical CRS unless the band names one") {
    const TempFolder folder;
    // NAVD88 height (ftUS) over UTM 11N.
    Spec spec{.values = ramp(12), .creation = {"GEOTIFF_VERSION=1.1"}, .crs = "EPSG:26911+6360"};
    DemSource source = open_ok({write_raster(folder.file("a.tif"), spec)});
    CHECK(all_heights(source)[10] == doctest::Approx(10 * 1200.0 / 3937.0));
    CHECK(source.info().crs_wkt.find("VERT") == std::string::npos);
}

TEST_CASE("Web Mercator counts as metric and is not resampled") {
    const TempFolder folder;
    Spec spec{.values = ramp(12),
              .transform = std::array<double, 6>{-2000000, 4891.97, 0, 8810437.5, 0, -4891.97},
              .crs = "EPSG:3857"};
    DemSource source = open_ok({write_raster(folder.file("a.tif"), spec)});
    CHECK_FALSE(source.info().warped);
    CHECK(source.info().spacing_x_m == 4891.97);
}

TEST_CASE("a raster that names no CRS is in metres, or in --crs, or in degrees where it looks so") {
    const TempFolder folder;
    const std::string metric = write_raster(folder.file("a.tif"), {.values = ramp(12), .crs = ""});
    CHECK(open_ok({metric}).info().crs_wkt.empty());
    CHECK(open_ok({metric}).info().georeferenced);
    CHECK(says(open_ok({metric}).info().notes, "taken as metres"));
    CHECK(open_ok({metric}, {.crs = "EPSG:32633"}).info().crs_wkt.find("32633") != std::string::npos);
    CHECK_FALSE(open_ok({metric}, {.crs = "EPSG:32633"}).info().warped);
    const std::string degrees = write_raster(
        folder.file("b.tif"),
        {.values = ramp(12), .transform = std::array<double, 6>{8, 0.01, 0, 47, 0, -0.01}, .crs = ""});
    CHECK(open_ok({degrees}).info().warped);
    CHECK(says(open_ok({degrees}).info().notes, "WGS 84"));
}

TEST_CASE("a CRS to build in must be projected and known") {
    const TempFolder folder;
    const std::string path = write_raster(folder.file("a.tif"), {.values = ramp(12)});
    const auto geographic = DemSource::open({path}, {.crs = "EPSG:4326"});
    REQUIRE_FALSE(geographic.ok());
    CHECK(geographic.error().message.find("not a projected CRS") != std::string::npos);
    const auto unknown = DemSource::open({path}, {.crs = "EPSG:99"});
    REQUIRE_FALSE(unknown.ok());
    CHECK(unknown.error().message.rfind("--crs EPSG:99: ", 0) == 0);
    CHECK_FALSE(open_ok({path}, {.crs = "EPSG:32633"}).info().warped);
    CHECK(open_ok({path}, {.crs = "EPSG:32632"}).info().warped);
}

TEST_CASE("tiles on one lattice join without resampling, in any order, with gaps as nodata") {
    const TempFolder folder;
    const std::vector<double> whole = ramp(6 * 8);
    std::vector<std::string> paths;
    for (const auto& [column, row] : {std::pair{3, 4}, std::pair{0, 0}, std::pair{3, 0}, std::pair{0, 4}}) {
        Spec spec{.width = 3, .height = 4};
        for (int j = 0; j < 4; ++j)
            for (int i = 0; i < 3; ++i)
                spec.values.push_back(whole[static_cast<std::size_t>((row + j) * 6 + column + i)]);
        spec.transform = std::array<double, 6>{500000.0 + 10 * column, 10, 0, 5200000.0 - 10 * row, 0, -10};
        paths.push_back(write_raster(folder.file(std::to_string(paths.size()) + ".tif"), spec));
    }
    DemSource source = open_ok(paths);
    REQUIRE(source.info().width == 6);
    REQUIRE(source.info().height == 8);
    CHECK(source.info().north_north_m == 5199995.0);
    CHECK(source.info().integer_heights);
    CHECK_FALSE(source.info().warped);
    CHECK(same_heights(all_heights(source, 3), whole));
    CHECK(source.counts().nodata == 0);

    paths.pop_back();  // the south-west quarter
    DemSource gap = open_ok(paths);
    std::vector<double> expected = whole;
    for (int j = 4; j < 8; ++j)
        for (int i = 0; i < 3; ++i) expected[static_cast<std::size_t>(j * 6 + i)] = kNaN;
    CHECK(same_heights(all_heights(gap), expected));
    CHECK(all_steps(gap).at(5 * 6) == kNoStep);
}

TEST_CASE("later rasters cover earlier ones, but not with their nodata; types, scales and marks may differ") {
    const TempFolder folder;
    Spec under{.values = ramp(12, 100), .type = GDT_Float32, .nodata = 105.0};
    Spec over{.values = std::vector<double>(12, 70), .type = GDT_Int16, .nodata = -1.0, .scale = 0.1};
    over.values[0] = -1;
    over.transform = std::array<double, 6>{500020, 10, 0, 5200000, 0, -10};
    DemSource source =
        open_ok({write_raster(folder.file("a.tif"), under), write_raster(folder.file("b.tif"), over)});
    CHECK(source.info().width == 6);
    CHECK_FALSE(source.info().integer_heights);
    const auto heights = all_heights(source);
    CHECK(heights[0] == 100.0);
    CHECK(heights[2] == 102.0);  // under the hole in `over`
    CHECK(heights[3] == doctest::Approx(7.0));
    CHECK(heights[5] == doctest::Approx(7.0));
    CHECK(std::isnan(heights[6 + 1]));  // 105 is nodata below, and `over` does not reach it
    CHECK(heights[6 + 3] == doctest::Approx(7.0));
}

TEST_CASE("more files than may be open at once make one mosaic") {
    const TempFolder folder;
    std::vector<std::string> paths;
    for (int i = 0; i < 230; ++i) {
        Spec spec{.width = 2, .height = 2, .values = std::vector<double>(4, i)};
        spec.transform = std::array<double, 6>{500000.0 + 20 * i, 10, 0, 5200000, 0, -10};
        paths.push_back(write_raster(folder.file(std::to_string(i) + ".tif"), spec));
    }
    DemSource source = open_ok(paths);
    REQUIRE(source.info().width == 460);
    for (int pass = 0; pass < 2; ++pass) {
        const auto heights = all_heights(source, 1);
        for (std::size_t i = 0; i < heights.size(); ++i)
            CHECK(heights[i] == static_cast<double>(i % 460 / 2));
    }
}

TEST_CASE("rasters without a place cannot be mosaicked") {
    const TempFolder folder;
    const std::string placed = write_raster(folder.file("a.tif"), {.values = ramp(12)});
    const std::string nowhere =
        write_raster(folder.file("b.tif"), {.values = ramp(12), .transform = std::nullopt, .crs = ""});
    const auto source = DemSource::open({placed, nowhere});
    REQUIRE_FALSE(source.ok());
    CHECK(source.error().message.rfind(nowhere, 0) == 0);
}
