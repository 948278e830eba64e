// Pictures of every kind that GDAL reads, as colours on a lattice over a terrain: values, holes, places,
// mosaics.
#include <doctest/doctest.h>

#include <functional>

#include "ridgeline/raster/image_source.h"
#include "unit/raster_fixture.h"

using namespace ridgeline::raster;

namespace {

using Bytes = std::array<int, 4>;

// A picture to write; values band by band, row by row, the file's first row first.
struct Picture {
    int width = 4, height = 3;
    std::vector<std::vector<double>> bands;
    GDALDataType type = GDT_Byte;
    std::optional<std::array<double, 6>> transform = std::array<double, 6>{500000, 10, 0, 5200000, 0, -10};
    std::string crs = "EPSG:32633";
    std::vector<GDALColorInterp> meanings;
    std::vector<std::string> creation;
    std::optional<double> nodata;
    std::vector<GDALColorEntry> palette;
    std::vector<double> mask;
};

std::string write(const std::string& path, const Picture& picture) {
    GDALAllRegister();
    CPLSetThreadLocalConfigOption("GDAL_TIFF_INTERNAL_MASK", "YES");
    CPLStringList options;
    for (const std::string& option : picture.creation) options.AddString(option.c_str());
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
    GDALDatasetUniquePtr dataset(driver->Create(path.c_str(), picture.width, picture.height,
                                                static_cast<int>(picture.bands.size()), picture.type,
                                                options.List()));
    REQUIRE(dataset);
    if (picture.transform) {
        std::array<double, 6> transform = *picture.transform;
        dataset->SetGeoTransform(transform.data());
    }
    if (!picture.crs.empty()) {
        OGRSpatialReference crs;
        REQUIRE(crs.SetFromUserInput(picture.crs.c_str()) == OGRERR_NONE);
        crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
        dataset->SetSpatialRef(&crs);
    }
    if (!picture.palette.empty()) {
        GDALColorTable table;
        for (std::size_t i = 0; i < picture.palette.size(); ++i)
            table.SetColorEntry(static_cast<int>(i), &picture.palette[i]);
        dataset->GetRasterBand(1)->SetColorTable(&table);
    }
    for (std::size_t i = 0; i < picture.bands.size(); ++i) {
        GDALRasterBand& band = *dataset->GetRasterBand(static_cast<int>(i) + 1);
        if (i < picture.meanings.size()) band.SetColorInterpretation(picture.meanings[i]);
        if (picture.nodata) band.SetNoDataValue(*picture.nodata);
    }
    if (!picture.mask.empty()) {
        REQUIRE(dataset->CreateMaskBand(GMF_PER_DATASET) == CE_None);
        write_band(*dataset->GetRasterBand(1)->GetMaskBand(), picture.mask);
    }
    for (std::size_t i = 0; i < picture.bands.size(); ++i)
        write_band(*dataset->GetRasterBand(static_cast<int>(i) + 1), picture.bands[i]);
    return path;
}

// A terrain whose samples' centres are the corners of the default picture's area, or of a larger one.
TerrainPlace terrain_of(double west, double south, double east, double north,
                        const std::string& crs = "EPSG:32633") {
    TerrainPlace place;
    place.west_m = west, place.south_m = south, place.east_m = east, place.north_m = north;
    place.spacing_x_m = place.spacing_y_m = 10.0;
    if (crs.empty()) return place;
    OGRSpatialReference reference;
    REQUIRE(reference.SetFromUserInput(crs.c_str()) == OGRERR_NONE);
    char* wkt = nullptr;
    reference.exportToWkt(&wkt);
    place.crs_wkt = wkt;
    CPLFree(wkt);
    return place;
}
TerrainPlace under_default() { return terrain_of(500000, 5199970, 500040, 5200000); }

ImageSource opened(const std::vector<std::string>& paths, const TerrainPlace& place) {
    auto source = ImageSource::open(paths, place);
    REQUIRE_MESSAGE(source.ok(), (source.ok() ? "" : source.error().message));
    return std::move(*source);
}

// All colours, read in bands of two rows.
std::vector<Bytes> colours(ImageSource& source) {
    const ImageSourceInfo& info = source.info();
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(info.width * info.height * 4));
    for (std::int64_t row = 0; row < info.height; row += 2) {
        const std::int64_t rows = std::min<std::int64_t>(2, info.height - row);
        const auto band = std::span(bytes).subspan(static_cast<std::size_t>(row * info.width * 4),
                                                   static_cast<std::size_t>(rows * info.width * 4));
        const auto read = source.read_rows(row, rows, band);
        REQUIRE_MESSAGE(read.ok(), (read.ok() ? "" : read.error().message));
    }
    std::vector<Bytes> out;
    for (std::size_t i = 0; i < bytes.size(); i += 4)
        out.push_back({bytes[i], bytes[i + 1], bytes[i + 2], bytes[i + 3]});
    return out;
}

std::vector<Bytes> colours_of(const TempFolder& folder, const Picture& picture) {
    auto source = opened({write(folder.file("picture.tif"), picture)}, under_default());
    return colours(source);
}

std::string refusal(const std::vector<std::string>& paths, const TerrainPlace& place) {
    const auto source = ImageSource::open(paths, place);
    REQUIRE_FALSE(source.ok());
    CHECK(source.error().message.find('\n') == std::string::npos);
    return source.error().message;
}

Picture rgb(int width, int height, const std::function<Bytes(int x, int y)>& colour) {
    Picture picture;
    picture.width = width, picture.height = height;
    picture.bands.resize(3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (std::size_t c = 0; c < 3; ++c) picture.bands[c].push_back(colour(x, y)[c]);
    picture.meanings = {GCI_RedBand, GCI_GreenBand, GCI_BlueBand};
    return picture;
}

Bytes random_colour(int x, int y) {
    const auto h = static_cast<unsigned>(x * 7919 + y * 104729) * 2654435761u;
    return {static_cast<int>(h >> 24), static_cast<int>(h >> 16 & 255), static_cast<int>(h >> 8 & 255), 255};
}

}  // namespace

TEST_CASE("picture: bands are found by what they are, whatever their order, alpha and grey included") {
    const TempFolder folder;
    Picture picture;
    picture.bands = {ramp(12, 0), ramp(12, 100), ramp(12, 200)};
    picture.meanings = {GCI_BlueBand, GCI_GreenBand, GCI_RedBand};
    CHECK(colours_of(folder, picture)[5] == Bytes{205, 105, 5, 255});

    picture.meanings = {GCI_RedBand, GCI_GreenBand, GCI_BlueBand, GCI_AlphaBand};
    picture.bands.push_back({255, 0, 127, 128, 255, 0, 0, 0, 0, 0, 0, 255});
    const auto with_alpha = colours_of(folder, picture);
    CHECK(with_alpha[0] == Bytes{0, 100, 200, 255});
    CHECK(with_alpha[1] == Bytes{0, 0, 0, 0});
    CHECK(with_alpha[2] == Bytes{0, 0, 0, 0});
    CHECK(with_alpha[3] == Bytes{3, 103, 203, 255});

    Picture grey;
    grey.bands = {ramp(12, 40)};
    CHECK(colours_of(folder, grey)[11] == Bytes{51, 51, 51, 255});
    grey.bands.push_back(ramp(12, 120, 2));
    grey.meanings = {GCI_GrayIndex, GCI_AlphaBand};
    const auto grey_alpha = colours_of(folder, grey);
    CHECK(grey_alpha[3] == Bytes{0, 0, 0, 0});
    CHECK(grey_alpha[4] == Bytes{44, 44, 44, 255});
}

TEST_CASE("picture: palettes are expanded, with their transparent entries and their nodata") {
    const TempFolder folder;
    Picture picture;
    picture.bands = {{0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3}};
    picture.palette = {{10, 20, 30, 255}, {200, 100, 50, 255}, {1, 2, 3, 255}, {9, 9, 9, 255}};
    picture.nodata = 3;
    const auto got = colours_of(folder, picture);
    CHECK(got[0] == Bytes{10, 20, 30, 255});
    CHECK(got[1] == Bytes{200, 100, 50, 255});
    CHECK(got[2] == Bytes{1, 2, 3, 255});
    CHECK(got[3] == Bytes{0, 0, 0, 0});

    // TIFF knows no transparent entries; other formats do.
    const std::string vrt = folder.file("picture.vrt");
    {
        const GDALDatasetUniquePtr tif(GDALDataset::Open(folder.file("picture.tif").c_str(), GDAL_OF_RASTER));
        const GDALDatasetUniquePtr copy(GetGDALDriverManager()->GetDriverByName("VRT")->CreateCopy(
            vrt.c_str(), tif.get(), FALSE, nullptr, nullptr, nullptr));
        GDALColorTable table;
        for (int i = 0; i < 4; ++i) {
            const GDALColorEntry entry{static_cast<short>(10 * i), 5, 6,
                                       static_cast<short>(i == 2 ? 0 : 255)};
            table.SetColorEntry(i, &entry);
        }
        REQUIRE(copy->GetRasterBand(1)->SetColorTable(&table) == CE_None);
    }
    auto source = opened({vrt}, under_default());
    const auto through = colours(source);
    CHECK(through[1] == Bytes{10, 5, 6, 255});
    CHECK(through[2] == Bytes{0, 0, 0, 0});
}

TEST_CASE("picture: nodata is a colour, not a value; a mask counts as well") {
    const TempFolder folder;
    Picture picture = rgb(4, 3, [](int x, int) { return Bytes{0, x == 1 ? 0 : 7, x < 2 ? 0 : 9, 255}; });
    picture.nodata = 0;
    const auto got = colours_of(folder, picture);
    CHECK(got[0] == Bytes{0, 7, 0, 255});
    CHECK(got[1] == Bytes{0, 0, 0, 0});
    CHECK(got[2] == Bytes{0, 7, 9, 255});

    Picture masked = rgb(4, 3, random_colour);
    masked.mask = {255, 255, 0, 255, 255, 255, 255, 255, 255, 255, 255, 0};
    const auto behind = colours_of(folder, masked);
    CHECK(behind[1] == random_colour(1, 0));
    CHECK(behind[2] == Bytes{0, 0, 0, 0});
    CHECK(behind[11] == Bytes{0, 0, 0, 0});
}

TEST_CASE("picture: sixteen bits are spread between their darkest and brightest, and it is said") {
    const TempFolder folder;
    Picture picture;
    picture.type = GDT_UInt16;
    picture.width = 100, picture.height = 90;
    picture.bands.assign(3, ramp(9000, 6000, 1.0));
    picture.transform = std::array<double, 6>{500000, 1, 0, 5200000, 0, -1};
    auto source =
        opened({write(folder.file("a.tif"), picture)}, terrain_of(500000, 5199910, 500100, 5200000));
    CHECK(says(source.info().notes, "a.tif: UInt16: values 6"));
    const auto got = colours(source);
    CHECK(got[0] == Bytes{0, 0, 0, 255});
    CHECK(got[8999] == Bytes{255, 255, 255, 255});
    CHECK(std::abs(got[4500][0] - 128) <= 2);

    picture.bands.assign(3, ramp(9000, 0, 65535.0 / 8999));
    auto full = opened({write(folder.file("b.tif"), picture)}, terrain_of(500000, 5199910, 500100, 5200000));
    CHECK(says(full.info().notes, "0 to 65535"));
    picture.type = GDT_Float32;
    picture.bands.assign(3, ramp(9000, 0, 1.0 / 8999));
    auto unit = opened({write(folder.file("c.tif"), picture)}, terrain_of(500000, 5199910, 500100, 5200000));
    CHECK(says(unit.info().notes, "0 to 1"));
    picture.bands.resize(1);
    auto dem = opened({write(folder.file("e.tif"), picture)}, terrain_of(500000, 5199910, 500100, 5200000));
    CHECK(says(dem.info().notes, "one band of Float32: shown in grey"));
    picture.type = GDT_Int16;
    picture.bands.assign(3, ramp(9000, 0, 255.0 / 8999));
    auto bytes = opened({write(folder.file("d.tif"), picture)}, terrain_of(500000, 5199910, 500100, 5200000));
    CHECK(says(bytes.info().notes, "0 to 255"));
}

TEST_CASE("picture: inks are turned to colours; what has no colours is refused in a line that names it") {
    const TempFolder folder;
    Picture inks;
    inks.bands = {ramp(12, 0, 20), ramp(12, 0, 0), ramp(12, 255, 0), ramp(12, 0, 0)};
    inks.creation = {"PHOTOMETRIC=CMYK"};
    const auto got = colours_of(folder, inks);
    CHECK(got[0] == Bytes{255, 255, 0, 255});
    CHECK(got[5] == Bytes{155, 255, 0, 255});

    Picture two;
    two.bands = {ramp(12), ramp(12)};
    CHECK(refusal({write(folder.file("two.tif"), two)}, under_default()).find("two.tif: has 2 bands") !=
          std::string::npos);
    Picture complex;
    complex.bands = {ramp(12)};
    complex.type = GDT_CFloat32;
    CHECK(refusal({write(folder.file("complex.tif"), complex)}, under_default()).find("complex") !=
          std::string::npos);
    CHECK(refusal({folder.file("absent.tif")}, under_default()).find("absent.tif") != std::string::npos);
}

TEST_CASE("picture: a north-up one in the terrain's CRS is clipped to the terrain and never resampled") {
    const TempFolder folder;
    Picture picture = rgb(60, 50, random_colour);
    picture.transform = std::array<double, 6>{500003, 7, 0, 5200001, 0, -9};
    const auto path = write(folder.file("a.tif"), picture);
    // From within texel (5, 4) to within texel (31, 40).
    auto source = opened(
        {path}, terrain_of(500003 + 5.5 * 7, 5200001 - 40.2 * 9, 500003 + 31.7 * 7, 5200001 - 4.1 * 9));
    const ImageSourceInfo& info = source.info();
    CHECK(info.width == 27);
    CHECK(info.height == 37);
    CHECK(info.west_m == doctest::Approx(500003 + 5 * 7));
    CHECK(info.north_m == doctest::Approx(5200001 - 4 * 9));
    CHECK(info.spacing_x_m == doctest::Approx(7));
    CHECK(info.spacing_y_m == doctest::Approx(9));
    const auto got = colours(source);
    bool same = true;
    for (int y = 0; y < 37; ++y)
        for (int x = 0; x < 27; ++x)
            same &= got[static_cast<std::size_t>(y * 27 + x)] == random_colour(5 + x, 4 + y);
    CHECK(same);

    // South-up and mirrored: the same picture.
    Picture turned = rgb(60, 50, [](int x, int y) { return random_colour(59 - x, 49 - y); });
    turned.transform = std::array<double, 6>{500003 + 60 * 7, -7, 0, 5200001 - 50 * 9, 0, 9};
    auto other =
        opened({write(folder.file("b.tif"), turned)},
               terrain_of(500003 + 5.5 * 7, 5200001 - 40.2 * 9, 500003 + 31.7 * 7, 5200001 - 4.1 * 9));
    CHECK(colours(other) == got);
}

TEST_CASE("pictures: later ones cover earlier ones where they have a colour; the finest has the lattice") {
    const TempFolder folder;
    const Picture first = rgb(20, 20, [](int, int) { return Bytes{255, 0, 0, 255}; });
    Picture second = rgb(10, 10, [](int x, int y) { return Bytes{0, x == y ? 0 : 200, 0, 255}; });
    second.transform = std::array<double, 6>{500050, 10, 0, 5200000 - 50, 0, -10};
    second.nodata = 0;
    const std::string a = write(folder.file("a.tif"), first), b = write(folder.file("b.tif"), second);
    const TerrainPlace place = terrain_of(500000, 5199800, 500200, 5200000);
    auto both = opened({a, b}, place);
    const auto got = colours(both);
    CHECK(got[0] == Bytes{255, 0, 0, 255});
    CHECK(got[5 * 20 + 6] == Bytes{0, 200, 0, 255});
    CHECK(got[5 * 20 + 5] == Bytes{255, 0, 0, 255});
    auto reversed = opened({b, a}, place);
    CHECK(colours(reversed)[5 * 20 + 6] == Bytes{255, 0, 0, 255});

    Picture fine = rgb(40, 40, random_colour);
    fine.transform = std::array<double, 6>{500100, 2.5, 0, 5200000, 0, -2.5};
    auto mixed = opened({a, write(folder.file("fine.tif"), fine)}, place);
    CHECK(mixed.info().spacing_x_m == doctest::Approx(2.5));
    CHECK(mixed.info().width == 80);
    CHECK(says(mixed.info().notes, "a.tif: is resampled onto a finer picture's lattice"));
    const auto texels = colours(mixed);
    CHECK(texels[7 * 80 + 40 + 11] == random_colour(11, 7));
    CHECK(texels[79 * 80 + 3] == Bytes{255, 0, 0, 255});
    CHECK_FALSE(says(mixed.info().notes, "times the texels"));
}

TEST_CASE("pictures: a small one that makes the whole layer fine is told, and one whose texels are huge") {
    const TempFolder folder;
    Picture broad = rgb(20, 20, random_colour);
    broad.transform = std::array<double, 6>{500000, 10, 0, 5200000, 0, -10};
    Picture fine = rgb(40, 40, random_colour);
    fine.transform = std::array<double, 6>{500100, 0.5, 0, 5200000, 0, -0.5};
    const std::string a = write(folder.file("broad.tif"), broad), b = write(folder.file("fine.tif"), fine);
    const TerrainPlace place = terrain_of(500000, 5199800, 500200, 5200000);
    auto both = opened({a, b}, place);
    // 400 x 400 texels of 20 x 20 and 40 x 40.
    CHECK(
        says(both.info().notes, "fine.tif: is so much finer than the others that the imagery has 80 times"));
    auto alone = opened({a}, place);
    CHECK_FALSE(says(alone.info().notes, "times the texels"));
    CHECK_FALSE(says(alone.info().notes, "samples of the heights"));
    Picture one = rgb(1, 1, random_colour);
    one.transform = std::array<double, 6>{500000, 2000, 0, 5200000, 0, -2000};
    auto texel = opened({write(folder.file("one.tif"), one)}, place);
    CHECK(says(texel.info().notes, "one.tif: a texel of it covers 200 samples of the heights each way"));
}

TEST_CASE("pictures: what has no place, or lies elsewhere, is refused in one line") {
    const TempFolder folder;
    const Picture picture = rgb(20, 20, random_colour);
    const std::string path = write(folder.file("a.tif"), picture);
    CHECK(refusal({path}, terrain_of(600000, 5199800, 600200, 5200000)).find("does not touch the terrain") !=
          std::string::npos);
    Picture nowhere = picture;
    nowhere.transform.reset();
    nowhere.crs.clear();
    const std::string lost = write(folder.file("b.tif"), nowhere);
    CHECK(refusal({lost}, under_default()).find("b.tif: has no georeference") != std::string::npos);
    CHECK(refusal({path}, terrain_of(500000, 5199800, 500200, 5200000, "")).find("the terrain has none") !=
          std::string::npos);
    // A terrain in pixels takes it, whole, whatever its size.
    TerrainPlace pixels;
    pixels.east_m = 39, pixels.north_m = 9;
    auto spread = opened({lost}, pixels);
    CHECK(spread.info().width == 20);
    // Of twenty rows the outermost lie beyond the samples' centres.
    CHECK(spread.info().height == 18);
    CHECK(spread.info().west_m == doctest::Approx(-0.5));
    CHECK(spread.info().north_m == doctest::Approx(9.0));
    CHECK(spread.info().spacing_x_m == doctest::Approx(2.0));
    CHECK(spread.info().spacing_y_m == doctest::Approx(0.5));
    // One that tells where but not in what is taken to be in the terrain's CRS.
    Picture silent = picture;
    silent.crs.clear();
    auto taken = opened({write(folder.file("c.tif"), silent)}, terrain_of(500000, 5199800, 500200, 5200000));
    CHECK(says(taken.info().notes, "taken to be in the terrain's"));
    CHECK(colours(taken)[3] == random_colour(3, 0));
}

TEST_CASE("picture: from another CRS every texel comes from its place, to a fiftieth of a texel") {
    const TempFolder folder;
    // A checkerboard of degrees, and soft edges between its fields so that positions can be read off.
    Picture picture = rgb(200, 160, [](int x, int y) {
        const double wave = std::sin(0.2 * (x + 0.5)), other = std::cos(0.23 * (y + 0.5));
        return Bytes{static_cast<int>(127.5 + 120 * wave), static_cast<int>(127.5 + 120 * other),
                     (x / 8 + y / 8) % 2 == 0 ? 255 : 0, 255};
    });
    const double step = 0.0002;
    picture.transform = std::array<double, 6>{15.02, step, 0, 47.05, 0, -step};
    picture.crs = "EPSG:4326";
    const std::string path = write(folder.file("degrees.tif"), picture);
    auto source = opened({path}, terrain_of(501600, 5207800, 504400, 5211000));
    const ImageSourceInfo& info = source.info();
    const auto got = colours(source);

    OGRSpatialReference from, to;
    from.SetFromUserInput("EPSG:32633"), to.SetFromUserInput("EPSG:4326");
    from.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER),
        to.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    const std::unique_ptr<OGRCoordinateTransformation> transform(
        OGRCreateCoordinateTransformation(&from, &to));
    int compared = 0, wrong = 0, wrong_fields = 0;
    double drift_x = 0.0, drift_y = 0.0;
    for (std::int64_t y = 0; y < info.height; ++y)
        for (std::int64_t x = 0; x < info.width; ++x) {
            double east = info.west_m + (static_cast<double>(x) + 0.5) * info.spacing_x_m;
            double north = info.north_m - (static_cast<double>(y) + 0.5) * info.spacing_y_m;
            REQUIRE(transform->Transform(1, &east, &north));
            // In samples from the first one's centre.
            const double column = (east - 15.02) / step - 0.5, row = (47.05 - north) / step - 0.5;
            const Bytes& colour = got[static_cast<std::size_t>(y * info.width + x)];
            if (column < -0.55 || row < -0.55 || column > 199.55 || row > 159.55) {
                wrong += colour[3] != 0 ? 1 : 0;
                continue;
            }
            if (column < 0.5 || row < 0.5 || column > 198.5 || row > 158.5) continue;
            ++compared;
            // The waves are smooth enough for their own values to stand for bilinear ones, within 1 %.
            const double red = 127.5 + 120 * std::sin(0.2 * (column + 0.5));
            const double green = 127.5 + 120 * std::cos(0.23 * (row + 0.5));
            wrong += colour[3] == 255 && std::abs(colour[0] - red) < 3.0 && std::abs(colour[1] - green) < 3.5
                         ? 0
                         : 1;
            // Where along the wave the value lies tells the shift.
            drift_x += (colour[0] + 0.5 - red) * std::cos(0.2 * (column + 0.5));
            drift_y += (colour[1] + 0.5 - green) * -std::sin(0.23 * (row + 0.5));
            // Well inside a field of the board it has the field's colour.
            const double in_x = std::abs(std::fmod(column + 0.5, 8.0) - 4.0),
                         in_y = std::abs(std::fmod(row + 0.5, 8.0) - 4.0);
            if (in_x > 3.4 || in_y > 3.4) continue;
            const bool light =
                (static_cast<int>((column + 0.5) / 8) + static_cast<int>((row + 0.5) / 8)) % 2 == 0;
            wrong_fields += colour[2] == (light ? 255 : 0) ? 0 : 1;
        }
    CHECK(compared > 20000);
    CHECK(wrong == 0);
    CHECK(wrong_fields == 0);
    // Mean slopes along the waves: 120 · 0.2 and 120 · 0.23 a sample, half of that over cos².
    CHECK(std::abs(drift_x / compared / (0.5 * 120 * 0.2)) < 0.02);
    CHECK(std::abs(drift_y / compared / (0.5 * 120 * 0.23)) < 0.02);
}
