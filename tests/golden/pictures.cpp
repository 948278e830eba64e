// Pictures against those kept beside this file: what is drawn does not change unnoticed.
//
// Made by Ridgeline itself from a raster that this test writes: RIDGELINE_UPDATE_GOLDEN=1 writes them anew,
// and then somebody looks at them. Compared with a tolerance, since drivers round differently.
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#include <stb/stb_image.h>

#include "ridgeline/app/walk/stage.h"
#include "ridgeline/build/builder.h"
#include "ridgeline/gl/screenshot.h"
#include "support/gl_context.h"
#include "unit/raster_fixture.h"

using namespace ridgeline;

namespace {

constexpr glm::ivec2 kSize_px(480, 320);
constexpr int kWidth = 331, kHeight = 290;
constexpr double kSpacing_m = 40.0;
constexpr double kWest_m = 500000.0, kNorth_m = 5200000.0;
constexpr double kNodata = -32768.0;

// An island of ridges around a volcano, in a sea, with a lake of missing data on its flank.
double height_m(double column, double row) {
    const double x = (column - 165.0) / 165.0, y = (row - 140.0) / 140.0;
    const double radius = std::sqrt(x * x + y * y);
    const double massif = 2600.0 * std::exp(-3.2 * radius * radius);
    const double ridges = 420.0 * (1.0 - std::abs(std::sin(7.0 * x + 2.0 * std::sin(5.0 * y)))) *
                          (1.0 - std::abs(std::sin(6.0 * y - 2.5 * x)));
    const double crater = -700.0 * std::exp(-90.0 * radius * radius);
    const double shore = 900.0 * std::max(radius - 0.55, 0.0);
    return std::max(0.0, std::round(massif + ridges + crater - shore));
}
bool is_missing(double column, double row) { return std::hypot(column - 215.0, row - 190.0) < 14.0; }

std::filesystem::path build_store(const raster::TempFolder& folder) {
    raster::Spec spec{.width = kWidth, .height = kHeight};
    spec.transform = {kWest_m - 0.5 * kSpacing_m, kSpacing_m, 0, kNorth_m + 0.5 * kSpacing_m, 0, -kSpacing_m};
    spec.nodata = kNodata;
    for (int row = 0; row < kHeight; ++row)
        for (int column = 0; column < kWidth; ++column)
            spec.values.push_back(is_missing(column, row) ? kNodata : height_m(column, row));
    build::BuildOptions options;
    options.sources = {raster::write_raster(folder.file("island.tif"), spec)};
    options.out = folder.file("island.terrain");
    options.tile = 33;
    const auto built = build::build_terrain(options);
    REQUIRE_MESSAGE(built.ok(), (built.ok() ? "" : built.error().message));
    return options.out;
}

class Gallery {
  public:
    Gallery() : store_(std::move(io::Store::open(build_store(folder_))).value()) {
        app::StageOptions options;
        options.frame.size_px = kSize_px;
        options.frame.surfaces = render::Surfaces::all;
        options.wait = app::TileWait::settle;
        auto stage = app::TerrainStage::create(store_, jobs_, options);
        REQUIRE_MESSAGE(stage.ok(), (stage.ok() ? "" : stage.error().message));
        stage_ = std::move(stage).value();
    }

    gl::Image take(app::StageMoment moment) {
        moment.camera.lens.size_px = kSize_px;
        stage_->show(moment);
        return gl::read_image(stage_->target());
    }

  private:
    raster::TempFolder folder_;
    io::Store store_;
    jobs::JobSystem jobs_{{.workers = 1}};
    std::unique_ptr<app::TerrainStage> stage_;
};

app::StageMoment from(double column, double row, double height, double heading_deg, double pitch_deg) {
    app::StageMoment moment;
    moment.camera.pose = {{kWest_m + column * kSpacing_m, kNorth_m - row * kSpacing_m, height},
                          Angle::from_degrees(heading_deg),
                          Angle::from_degrees(pitch_deg)};
    return moment;
}

std::filesystem::path golden_file(const std::string& name) {
    return std::filesystem::path(RIDGELINE_SOURCE_DIR) / "tests/golden" / (name + ".png");
}

gl::Image load(const std::filesystem::path& file) {
    int width = 0, height = 0, channels = 0;
    stbi_uc* pixels = stbi_load(file.c_str(), &width, &height, &channels, 3);
    REQUIRE_MESSAGE(pixels, file.string());
    gl::Image image{{width, height}, {}};
    const auto* bytes = reinterpret_cast<const std::byte*>(pixels);
    image.rgb.assign(bytes, bytes + static_cast<std::ptrdiff_t>(width) * height * 3);
    stbi_image_free(pixels);
    return image;
}

struct Difference {
    double mean = 0.0;        // of 255
    std::size_t far_off = 0;  // values that differ by more than 24
};

Difference difference(const gl::Image& a, const gl::Image& b) {
    REQUIRE(a.size_px == b.size_px);
    Difference found;
    double sum = 0.0;
    for (std::size_t i = 0; i < a.rgb.size(); ++i) {
        const int off = std::abs(std::to_integer<int>(a.rgb[i]) - std::to_integer<int>(b.rgb[i]));
        sum += off;
        if (off > 24) ++found.far_off;
    }
    found.mean = sum / static_cast<double>(a.rgb.size());
    return found;
}

void compare(const gl::Image& image, const std::string& name) {
    if (std::getenv("RIDGELINE_UPDATE_GOLDEN")) {
        REQUIRE(gl::write_png(golden_file(name), image));
        return;
    }
    const Difference found = difference(image, load(golden_file(name)));
    CAPTURE(name);
    CHECK(found.mean < 0.75);
    // Edges may move by a part of a pixel.
    CHECK(found.far_off < image.rgb.size() / 400);
    if (found.mean >= 0.75)
        CHECK(gl::write_png(std::filesystem::temp_directory_path() / ("ridgeline-" + name + ".png"), image));
}

// A picture that is kept, and what it is called.
struct View {
    const char* name = "";
    app::StageMoment moment;
};

std::vector<View> views() {
    auto high_sun = from(215, 190, 5200.0, 0.0, -90.0);
    high_sun.background = render::PlainBackground{255, 0, 255};
    auto evening = from(60, 240, 900.0, 48.0, -3.0);
    evening.daylight = {Angle::from_degrees(262.0), Angle::from_degrees(9.0)};
    auto steep = from(40, 275, 5200.0, 40.0, -22.0);
    steep.exaggeration = 2.0;
    return {{"island", from(165, 285, 3600.0, 0.0, -24.0)},
            {"flank", from(95, 230, 700.0, 30.0, 4.0)},
            {"hole_from_above", high_sun},
            {"evening", evening},
            {"exaggerated", steep}};
}

}  // namespace

TEST_CASE("Pictures look as they did") {
    test::GlContext gl;
    if (!gl) return;
    Gallery gallery;
    for (const View& view : views()) compare(gallery.take(view.moment), view.name);
}

namespace {

// Each kept as NAME_VIEW.
void look_at_sampled(render::Surface surface, const std::string& name) {
    Gallery gallery;
    for (View view : views()) {
        const gl::Image mesh = gallery.take(view.moment);
        view.moment.surface = surface;
        const gl::Image sampled = gallery.take(view.moment);
        compare(sampled, name + "_" + view.name);
        CAPTURE(view.name);
        CHECK(difference(mesh, sampled).mean < 2.5);  // of 255
    }
}

}  // namespace

TEST_CASE("So do the disc's, which are not far from the mesh's") {
    test::GlContext gl;
    if (!gl) return;
    look_at_sampled(render::Surface::disc, "disc");
}

TEST_CASE("And so do the quadtree's") {
    test::GlContext gl;
    if (!gl) return;
    look_at_sampled(render::Surface::quadtree, "quadtree");
}
