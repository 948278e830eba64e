#include "unit/raster_fixture.h"

using namespace ridgeline::raster;

namespace {

struct TypeRange {
    GDALDataType type;
    double low;
    double high;
};

const TypeRange kIntegerTypes[] = {
    {GDT_Byte, 0, 255},   {GDT_Int16, -32768, 32767}, {GDT_UInt16, 0, 65535}, {GDT_Int32, -1e6, 1e6},
    {GDT_UInt32, 0, 1e6}, {GDT_Int64, -1e6, 1e6},     {GDT_UInt64, 0, 1e6},
};

}  // namespace

TEST_CASE("every integer type comes back exactly, as steps and as heights, whatever the band of rows") {
    const TempFolder folder;
    for (const TypeRange& range : kIntegerTypes) {
        CAPTURE(GDALGetDataTypeName(range.type));
        Spec spec{.width = 37, .height = 29, .type = range.type};
        spec.values = random_values(37 * 29, range.low, range.high, 7);
        DemSource source = open_ok({write_raster(folder.file("a.tif"), spec)});
        CHECK(source.info().integer_heights);
        CHECK(source.info().step_m == 1.0);
        CHECK_FALSE(source.info().warped);
        CHECK(same_heights(all_heights(source, 5), spec.values));
        const auto steps = all_steps(source);
        CHECK(std::equal(steps.begin(), steps.end(), spec.values.begin()));
    }
}

TEST_CASE("float heights come back exactly and are no integers") {
    const TempFolder folder;
    for (const GDALDataType type : {GDT_Float32, GDT_Float64}) {
        Spec spec{.type = type};
        spec.values = ramp(12, -3.25, 117.0625);
        DemSource source = open_ok({write_raster(folder.file("a.tif"), spec)});
        CHECK_FALSE(source.info().integer_heights);
        CHECK(source.info().may_have_nodata);
        CHECK(same_heights(all_heights(source), spec.values));
    }
}

TEST_CASE("signed bytes are signed") {
    const TempFolder folder;
    Spec spec{.type = GDT_Byte, .creation = {"PIXELTYPE=SIGNEDBYTE"}};
    spec.values = ramp(12, 250);
    for (double& value : spec.values) value = std::fmod(value, 256.0);
    DemSource source = open_ok({write_raster(folder.file("a.tif"), spec)});
    CHECK(same_heights(all_heights(source), ramp(12, -6)));
    CHECK(all_steps(source).front() == -6);
}

TEST_CASE("complex numbers are refused by name") {
    const TempFolder folder;
    const std::string path = write_raster(folder.file("a.tif"), {.type = GDT_CFloat32});
    const auto source = DemSource::open({path});
    REQUIRE_FALSE(source.ok());
    CHECK(source.error().message == path + ": holds complex numbers (CFloat32), not heights");
}

TEST_CASE("scale, offset and unit give metres, and integers stay integers") {
    const TempFolder folder;
    const struct {
        const char* unit;
        double metres;
    } units[] = {{"", 1.0},
                 {"m", 1.0},
                 {"metre", 1.0},
                 {"ft", 0.3048},
                 {"foot", 0.3048},
                 {"US survey foot", 1200.0 / 3937.0},
                 {"ftUS", 1200.0 / 3937.0},
                 {"cm", 0.01}};
    for (const auto& unit : units) {
        for (const double scale : {1.0, 0.1, -0.5}) {
            CAPTURE(unit.unit);
            CAPTURE(scale);
            Spec spec{.scale = scale, .offset = 12.0, .unit = unit.unit};
            spec.values = ramp(12, -20, 7);
            DemSource source = open_ok({write_raster(folder.file("a.tif"), spec)});
            const RasterInfo& info = source.info();
            REQUIRE(info.integer_heights);
            CHECK(info.step_m == doctest::Approx(std::abs(scale) * unit.metres));
            CHECK(info.step_m > 0);
            const auto heights = all_heights(source);
            const auto steps = all_steps(source);
            for (std::size_t i = 0; i < heights.size(); ++i) {
                CHECK(heights[i] == doctest::Approx((spec.values[i] * scale + 12.0) * unit.metres));
                CHECK(info.offset_m + steps[i] * info.step_m == doctest::Approx(heights[i]));
                CHECK(steps[i] == (scale < 0 ? -spec.values[i] : spec.values[i]));
            }
        }
    }
}

TEST_CASE("an unknown unit is taken as metres, and said") {
    const TempFolder folder;
    DemSource source = open_ok({write_raster(folder.file("a.tif"), {.values = ramp(12), .unit = "smoot"})});
    CHECK(same_heights(all_heights(source), ramp(12)));
    CHECK(says(source.info().notes, "\"smoot\" is not known"));
}

TEST_CASE("declared nodata is nodata in every type") {
    const TempFolder folder;
    for (const GDALDataType type : {GDT_Byte, GDT_Int16, GDT_UInt32, GDT_Int32, GDT_Float32, GDT_Float64}) {
        CAPTURE(GDALGetDataTypeName(type));
        Spec spec{.type = type, .nodata = 5.0};
        spec.values = ramp(12);
        DemSource source = open_ok({write_raster(folder.file("a.tif"), spec)});
        CHECK(source.info().may_have_nodata);
        std::vector<double> expected = ramp(12);
        expected[5] = kNaN;
        CHECK(same_heights(all_heights(source), expected));
        CHECK(source.counts().nodata == 1);
        CHECK(source.counts().samples == 12);
        if (source.info().integer_heights) CHECK(all_steps(source)[5] == kNoStep);
    }
}

TEST_CASE("a nodata value of the options stands in for the file's") {
    const TempFolder folder;
    Spec spec{.nodata = 5.0};
    spec.values = ramp(12);
    DemSource source = open_ok({write_raster(folder.file("a.tif"), spec)}, {.nodata = 7.0});
    std::vector<double> expected = ramp(12);
    expected[7] = kNaN;
    CHECK(same_heights(all_heights(source), expected));
}

TEST_CASE("a float's nodata is compared as the float it is stored as") {
    const TempFolder folder;
    Spec spec{.type = GDT_Float32, .nodata = -3.4028230607370965e+38};
    spec.values = ramp(12);
    spec.values[3] = -3.4028230607370965e+38;
    DemSource source = open_ok({write_raster(folder.file("a.tif"), spec)});
    CHECK(std::isnan(all_heights(source)[3]));
    CHECK(source.counts().out_of_range == 0);
}

TEST_CASE("what is no number, or no height, is nodata and counted") {
    const TempFolder folder;
    Spec spec{.type = GDT_Float64};
    spec.values = ramp(12);
    spec.values[1] = kNaN;
    spec.values[2] = std::numeric_limits<double>::infinity();
    spec.values[3] = -std::numeric_limits<double>::infinity();
    spec.values[4] = 1.0000001e6;
    spec.values[5] = -3e38;
    spec.values[6] = 1e6;
    DemSource source = open_ok({write_raster(folder.file("a.tif"), spec)});
    std::vector<double> expected = spec.values;
    std::fill(expected.begin() + 1, expected.begin() + 6, kNaN);
    CHECK(same_heights(all_heights(source), expected));
    CHECK(source.counts().not_finite == 3);
    CHECK(source.counts().out_of_range == 2);
    CHECK(source.counts().nodata == 5);
    CHECK(says(source.findings(), "3 samples are infinite or not a number"));
    CHECK(says(source.findings(), "2 samples lie beyond"));
}

TEST_CASE("integers beyond any height are nodata too") {
    const TempFolder folder;
    for (const GDALDataType type : {GDT_Int32, GDT_UInt32, GDT_Int64}) {
        Spec spec{.type = type};
        spec.values = ramp(12);
        spec.values[4] = 2147483647.0;
        DemSource source = open_ok({write_raster(folder.file("a.tif"), spec)});
        REQUIRE(source.info().integer_heights);
        CHECK(source.info().may_have_nodata);
        CHECK(all_steps(source)[4] == kNoStep);
        CHECK(all_steps(source)[5] == 5);
    }
}

TEST_CASE("without nodata, mask and wide types a raster promises to be whole") {
    const TempFolder folder;
    DemSource source = open_ok({write_raster(folder.file("a.tif"), {.values = ramp(12)})});
    CHECK_FALSE(source.info().may_have_nodata);
}

TEST_CASE("a mask band marks nodata") {
    const TempFolder folder;
    Spec spec{.values = ramp(12), .mask = std::vector<double>(12, 255.0)};
    spec.mask[0] = spec.mask[7] = 0;
    DemSource source = open_ok({write_raster(folder.file("a.tif"), spec)});
    std::vector<double> expected = ramp(12);
    expected[0] = expected[7] = kNaN;
    CHECK(source.info().may_have_nodata);
    CHECK(same_heights(all_heights(source, 1), expected));
    CHECK(all_steps(source)[7] == kNoStep);
}

TEST_CASE("an alpha band marks nodata") {
    const TempFolder folder;
    GDALAllRegister();
    const std::string path = folder.file("a.tif");
    {
        CPLStringList options;
        options.SetNameValue("ALPHA", "YES");
        GDALDatasetUniquePtr dataset(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
            path.c_str(), 4, 3, 2, GDT_Byte, options));
        write_band(*dataset->GetRasterBand(1), ramp(12));
        std::vector<double> alpha(12, 255.0);
        alpha[2] = 0.0;
        write_band(*dataset->GetRasterBand(2), alpha);
        dataset->GetRasterBand(2)->SetColorInterpretation(GCI_AlphaBand);
    }
    DemSource source = open_ok({path});
    std::vector<double> expected = ramp(12);
    expected[2] = kNaN;
    CHECK(same_heights(all_heights(source), expected));
    CHECK_FALSE(says(source.info().notes, "bands"));
}

TEST_CASE("a customary nodata value far below all others is nodata, declared or not") {
    const TempFolder folder;
    for (const double value : {-9999.0, -32767.0, -32768.0}) {
        Spec spec{.values = ramp(12)};
        spec.values[3] = value;
        const std::string path = write_raster(folder.file("a.tif"), spec);
        DemSource source = open_ok({path});
        CHECK(source.info().may_have_nodata);
        CHECK(says(source.info().notes, "undeclared nodata"));
        std::vector<double> expected = spec.values;
        expected[3] = kNaN;
        CHECK(same_heights(all_heights(source), expected));
        // Who says that NaN is the nodata value says that the others are not.
        DemSource kept = open_ok({path}, {.nodata = kNaN});
        CHECK(same_heights(all_heights(kept), spec.values));
        CHECK(kept.counts().suspect == 1);
        CHECK(says(kept.findings(), "use --nodata"));
    }
}

TEST_CASE("on ocean floors and in bands that use their whole range, customary nodata values are heights") {
    const TempFolder folder;
    DemSource trench = open_ok({write_raster(folder.file("a.tif"), {.values = ramp(12, -10010, 1)})});
    CHECK(same_heights(all_heights(trench), ramp(12, -10010, 1)));
    CHECK(trench.counts().suspect == 1);
    CHECK(trench.findings().empty());
    Spec whole_range{.width = 300, .height = 300, .values = random_values(90000, -32768, 32767, 3)};
    whole_range.values[7] = -32768;
    DemSource source = open_ok({write_raster(folder.file("b.tif"), whole_range)});
    CHECK(same_heights(all_heights(source), whole_range.values));
}

TEST_CASE(
    "rasters larger than the block cache are read to their end, on any number of threads, warped or not") {
    const TempFolder folder;
    Spec spec{.width = 700, .height = 700, .type = GDT_Float32};
    spec.values = random_values(700 * 700, 0, 3000, 2);
    spec.creation = {"TILED=YES", "COMPRESS=DEFLATE", "BLOCKXSIZE=64", "BLOCKYSIZE=64"};
    const std::string path = write_raster(folder.file("a.tif"), spec);
    for (const int threads : {1, 2, 5}) {
        DemSource source = open_ok({path}, {.cache_bytes = 300000, .threads = threads});
        CHECK(same_heights(all_heights(source, 128), spec.values));
        DemSource warped = open_ok({path}, {.crs = "EPSG:32632", .cache_bytes = 300000, .threads = threads});
        CHECK(all_heights(warped, 128).size() > spec.values.size());
    }
}
