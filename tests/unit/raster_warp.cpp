#include <functional>

#include "unit/raster_fixture.h"

using namespace ridgeline::raster;

namespace {

// The warper's own approximation of the transformation, with room for its rounding.
constexpr double kPositionError_px = 0.02;

class Transform {
  public:
    Transform(const std::string& from, const std::string& to) : from_(crs(from)), to_(crs(to)) {
        transform_.reset(OGRCreateCoordinateTransformation(&from_, &to_));
        REQUIRE(transform_);
    }
    std::array<double, 2> operator()(double x, double y) const {
        REQUIRE(transform_->Transform(1, &x, &y));
        return {x, y};
    }

  private:
    static OGRSpatialReference crs(const std::string& text) {
        OGRSpatialReference reference;
        REQUIRE(reference.SetFromUserInput(text.c_str()) == OGRERR_NONE);
        reference.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
        return reference;
    }
    OGRSpatialReference from_;
    OGRSpatialReference to_;
    std::unique_ptr<OGRCoordinateTransformation> transform_;
};

std::array<double, 2> world_of(const RasterInfo& info, std::int64_t column, std::int64_t row) {
    return {info.west_east_m + static_cast<double>(column) * info.spacing_x_m,
            info.north_north_m - static_cast<double>(row) * info.spacing_y_m};
}

// The slow reference: where a world position falls in the source, in samples from the first sample's centre.
std::array<double, 2> sample_position(const Spec& spec, const std::array<double, 2>& at) {
    std::array<double, 6> transform = *spec.transform;
    std::array<double, 6> inverse{};
    REQUIRE(GDALInvGeoTransform(transform.data(), inverse.data()));
    return {inverse[0] + inverse[1] * at[0] + inverse[2] * at[1] - 0.5,
            inverse[3] + inverse[4] * at[0] + inverse[5] * at[1] - 0.5};
}

bool inside(const Spec& spec, const std::array<double, 2>& position, double margin) {
    return position[0] >= margin && position[1] >= margin && position[0] <= spec.width - 1 - margin &&
           position[1] <= spec.height - 1 - margin;
}

bool outside_footprint(const Spec& spec, const std::array<double, 2>& position) {
    const double rim = 0.5 + kPositionError_px;
    return position[0] < -rim || position[1] < -rim || position[0] > spec.width - 1 + rim ||
           position[1] > spec.height - 1 + rim;
}

struct Corners {
    std::array<double, 4> values{};
    double u = 0;
    double v = 0;

    double bilinear() const {
        return (values[0] * (1 - u) + values[1] * u) * (1 - v) + (values[2] * (1 - u) + values[3] * u) * v;
    }
    bool all_heights(double nodata) const {
        return std::none_of(values.begin(), values.end(), [nodata](double value) { return value == nodata; });
    }
};

Corners corners_at(const Spec& spec, const std::array<double, 2>& position) {
    const int column = std::min(static_cast<int>(position[0]), spec.width - 2);
    const int row = std::min(static_cast<int>(position[1]), spec.height - 2);
    const auto at = [&spec](int x, int y) {
        return spec.values[static_cast<std::size_t>(y * spec.width + x)];
    };
    return {{at(column, row), at(column + 1, row), at(column, row + 1), at(column + 1, row + 1)},
            position[0] - column,
            position[1] - row};
}

// Holds a warped raster against the reference at every sample; white noise of `amplitude` shows any
// misplacement.
void check_against_reference(const Spec& spec, const RasterOptions& options, double amplitude) {
    const TempFolder folder;
    DemSource source = open_ok({write_raster(folder.file("a.tif"), spec)}, options);
    const RasterInfo& info = source.info();
    REQUIRE(info.warped);
    CHECK_FALSE(info.integer_heights);
    CHECK(info.may_have_nodata);
    CHECK(info.spacing_x_m == doctest::Approx(info.spacing_y_m));
    const auto heights = all_heights(source, 64);
    const Transform to_source(info.crs_wkt, spec.crs);
    const double nodata = spec.nodata.value_or(kNaN);
    // The gradient is at most `amplitude` a sample along either axis.
    const double tolerance = 2 * kPositionError_px * amplitude;
    std::size_t compared = 0;
    std::size_t misplaced = 0;
    std::size_t beyond = 0;
    std::size_t holes_filled = 0;
    for (std::int64_t row = 0; row < info.height; ++row) {
        for (std::int64_t column = 0; column < info.width; ++column) {
            const double height = heights[static_cast<std::size_t>(row * info.width + column)];
            const auto world = world_of(info, column, row);
            const auto position = sample_position(spec, to_source(world[0], world[1]));
            if (outside_footprint(spec, position)) beyond += !std::isnan(height);
            if (!inside(spec, position, kPositionError_px)) continue;
            const Corners corners = corners_at(spec, position);
            if (corners.all_heights(nodata)) {
                ++compared;
                misplaced += !(std::abs(height - corners.bilinear()) <= tolerance);
            } else if (!std::isnan(height)) {
                // Beside nodata a height still comes from heights alone.
                holes_filled += height < -tolerance || height > amplitude + tolerance;
            }
        }
    }
    CHECK(compared > 500);
    CHECK(misplaced == 0);
    CHECK(beyond == 0);
    CHECK(holes_filled == 0);
}

Spec noise(int width, int height, const std::array<double, 6>& transform, const std::string& crs) {
    Spec spec{.width = width, .height = height, .transform = transform, .crs = crs};
    spec.values = random_values(width * height, 0, 1000, 11);
    return spec;
}

const std::array<double, 6> kAlps{8, 1.0 / 1200, 0, 47, 0, -1.0 / 1200};

}  // namespace

TEST_CASE("degrees are warped to UTM with the bilinear values of an exact transformation") {
    check_against_reference(noise(60, 50, kAlps, "EPSG:4326"), {}, 1000);
    // Another datum stays itself: no datum shift.
    check_against_reference(noise(60, 50, {-118, 1.0 / 3600, 0, 34, 0, -1.0 / 3600}, "EPSG:4269"), {}, 1000);
    // In the north a degree of longitude is short: the kernel stays bilinear all the same.
    check_against_reference(noise(90, 40, {15, 1.0 / 1200, 0, 69, 0, -1.0 / 1200}, "EPSG:4326"), {}, 1000);
    check_against_reference(noise(60, 50, {170, 1.0 / 1200, 0, -43, 0, -1.0 / 1200}, "EPSG:4326"), {}, 1000);
    check_against_reference(noise(300, 40, {15, 1.0 / 50, 0, 86, 0, -1.0 / 400}, "EPSG:4326"), {}, 1000);
}

TEST_CASE("several threads warp to the same heights") {
    check_against_reference(noise(60, 50, kAlps, "EPSG:4326"), {.threads = 3}, 1000);
}

TEST_CASE("rotated and sheared rasters are warped on their own plane") {
    for (const double turn : {0.1, 0.7, 2.0, -3.0}) {
        const double c = 30 * std::cos(turn);
        const double s = 30 * std::sin(turn);
        check_against_reference(noise(60, 50, {500000, c, s, 5200000, s, -c}, "EPSG:32633"), {}, 1000);
    }
    check_against_reference(noise(60, 50, {500000, 30, 12, 5200000, 0, -30}, "EPSG:32633"), {}, 1000);
}

TEST_CASE("south-up degrees are warped the right way round") {
    check_against_reference(noise(60, 50, {8, 1.0 / 1200, 0, 46, 0, 1.0 / 1200}, "EPSG:4326"), {}, 1000);
}

TEST_CASE("a CRS to build in is built in") {
    check_against_reference(noise(60, 50, {500000, 30, 0, 5200000, 0, -30}, "EPSG:32633"),
                            {.crs = "EPSG:32632"}, 1000);
    check_against_reference(noise(60, 50, kAlps, "EPSG:4326"), {.crs = "EPSG:2056"}, 1000);
}

TEST_CASE("nodata never mixes into warped heights") {
    Spec spec = noise(80, 70, kAlps, "EPSG:4326");
    spec.nodata = -32768;
    std::mt19937 generator(3);
    for (double& value : spec.values)
        if (generator() % 8 == 0) value = -32768;
    check_against_reference(spec, {}, 1000);
}

TEST_CASE("the metric CRS fits where the degrees are") {
    const TempFolder folder;
    const struct {
        std::array<double, 6> transform;
        const char* says;
    } places[] = {
        {kAlps, "UTM zone 32N"},
        {{170, 0.01, 0, -43, 0, -0.01}, "UTM zone 59S"},
        {{10, 0.1, 0, 89, 0, -0.1}, "polar stereographic (north)"},
        {{10, 0.1, 0, -85, 0, -0.1}, "polar stereographic (south)"},
        {{-10, 1.0, 0, 60, 0, -1.0}, "Lambert azimuthal equal-area"},
        {{-180, 9.0, 0, 90, 0, -6.0}, "equidistant cylindrical"},
    };
    for (const auto& place : places) {
        CAPTURE(place.says);
        Spec spec = noise(40, 30, place.transform, "EPSG:4326");
        DemSource source = open_ok({write_raster(folder.file("a.tif"), spec)});
        CHECK(says(source.info().notes, place.says));
        const auto heights = all_heights(source);
        CHECK(std::any_of(heights.begin(), heights.end(), [](double height) { return !std::isnan(height); }));
    }
}

TEST_CASE("tiles in degrees join before they are warped: no seam") {
    const TempFolder folder;
    const Spec whole = noise(60, 50, kAlps, "EPSG:4326");
    std::vector<std::string> tiles;
    for (const int first : {0, 25}) {
        Spec tile{.width = 60, .height = 25, .crs = "EPSG:4326"};
        tile.values.assign(whole.values.begin() + first * 60, whole.values.begin() + (first + 25) * 60);
        tile.transform = std::array<double, 6>{8, 1.0 / 1200, 0, 47 - first / 1200.0, 0, -1.0 / 1200};
        tiles.push_back(write_raster(folder.file(std::to_string(first) + ".tif"), tile));
    }
    DemSource joined = open_ok(tiles);
    DemSource one = open_ok({write_raster(folder.file("whole.tif"), whole)});
    REQUIRE(joined.info().width == one.info().width);
    REQUIRE(joined.info().height == one.info().height);
    CHECK(same_heights(all_heights(joined), all_heights(one)));
}

TEST_CASE("rasters of different CRS and spacing join on the first one's lattice") {
    const TempFolder folder;
    const Transform to_degrees("EPSG:32633", "EPSG:4326");
    const Transform from_west("EPSG:32632", "EPSG:32633");
    const Transform from_degrees("EPSG:4326", "EPSG:32633");
    // One smooth landscape over the plane of zone 33, sampled by each raster at its own places.
    const auto height_at = [](const std::array<double, 2>& at) {
        return 500 + 200 * std::sin(at[0] / 900) + 150 * std::cos(at[1] / 700);
    };
    const auto sampled = [&](Spec spec,
                             const std::function<std::array<double, 2>(double, double)>& to_plane) {
        spec.type = GDT_Float64;
        const auto& t = *spec.transform;
        for (int row = 0; row < spec.height; ++row)
            for (int column = 0; column < spec.width; ++column)
                spec.values.push_back(
                    height_at(to_plane(t[0] + (column + 0.5) * t[1], t[3] + (row + 0.5) * t[5])));
        return spec;
    };
    const auto west = from_west(0, 0);  // only so that the transformation is known to work
    CHECK(std::isfinite(west[0]));
    const Transform to_west("EPSG:32633", "EPSG:32632");
    const auto corner = to_west(500900, 5200000);
    const auto degrees = to_degrees(500000, 5199200);
    const Spec first = sampled(
        {.width = 40, .height = 30, .transform = std::array<double, 6>{500000, 25, 0, 5200000, 0, -25}},
        [](double x, double y) {
            return std::array<double, 2>{x, y};
        });
    const Spec second = sampled({.width = 70,
                                 .height = 50,
                                 .transform = std::array<double, 6>{corner[0], 17, 0, corner[1], 0, -17},
                                 .crs = "EPSG:32632"},
                                [&](double x, double y) { return from_west(x, y); });
    const Spec third =
        sampled({.width = 50,
                 .height = 60,
                 .transform = std::array<double, 6>{degrees[0], 0.0003, 0, degrees[1], 0, -0.0002},
                 .crs = "EPSG:4326"},
                [&](double x, double y) { return from_degrees(x, y); });
    DemSource source =
        open_ok({write_raster(folder.file("a.tif"), first), write_raster(folder.file("b.tif"), second),
                 write_raster(folder.file("c.tif"), third)});
    const RasterInfo& info = source.info();
    CHECK(info.spacing_x_m == 25.0);
    CHECK(std::abs(std::remainder(info.west_east_m - 500012.5, 25.0)) < 1e-6);
    CHECK(info.width > 60);
    CHECK(info.height > 50);
    const auto heights = all_heights(source, 7);
    std::size_t known = 0;
    std::size_t wrong = 0;
    for (std::int64_t row = 0; row < info.height; ++row) {
        for (std::int64_t column = 0; column < info.width; ++column) {
            const double height = heights[static_cast<std::size_t>(row * info.width + column)];
            if (std::isnan(height)) continue;
            ++known;
            // Slopes reach 0.3: half a sample at a raster's rim, where the nearest value is held, is some
            // metres.
            wrong += std::abs(height - height_at(world_of(info, column, row))) > 5.0;
        }
    }
    CHECK(known > 3000);
    CHECK(wrong == 0);
}
