// Pictures of suite `metric` on a small store: what is written, and that it shows what was drawn.
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#include <stb/stb_image.h>

#include <cmath>
#include <memory>
#include <numeric>

#include "ridgeline/app/bench/metric_suite.h"
#include "ridgeline/app/bench/picture_sheet.h"
#include "ridgeline/app/bench/rendered_skyline.h"
#include "ridgeline/app/bench/skyline_views.h"
#include "ridgeline/app/bench/view_triangles.h"
#include "support/gl_context.h"
#include "unit/build_fixture.h"

using namespace ridgeline;
using namespace ridgeline::app;
using namespace ridgeline::test;

namespace {

// The same hills under both metrics.
struct BothMetrics {
    BothMetrics() : rows(rows_of(kHills)) {
        for (const auto metric : {build::Metric::geometric, build::Metric::cone}) {
            Case c = kHills;
            c.metric = metric;
            const auto out = folder.path() / build::metric_name(metric);
            REQUIRE(build::build_from_rows(rows, options_for(c, out)));
            auto opened = io::Store::open(out);
            REQUIRE(opened);
            stores.push_back(std::make_unique<io::Store>(std::move(*opened)));
        }
    }

    static constexpr Case kHills{513, 513, 33, false, 4};
    ScratchFolder folder;
    MemoryRows rows;
    std::vector<std::unique_ptr<io::Store>> stores;
};

MetricPictureOptions small_pictures(const std::filesystem::path& folder) {
    MetricPictureOptions options{.folder = folder};
    options.lens.size_px = {160, 90};
    options.magnification = 2;
    return options;
}

gl::Image load(const std::filesystem::path& file) {
    gl::Image image;
    int channels = 0;
    stbi_uc* pixels = stbi_load(file.c_str(), &image.size_px.x, &image.size_px.y, &channels, 3);
    REQUIRE(pixels != nullptr);
    const auto* bytes = reinterpret_cast<const std::byte*>(pixels);
    image.rgb.assign(bytes, bytes + static_cast<std::ptrdiff_t>(image.size_px.x) * image.size_px.y * 3);
    stbi_image_free(pixels);
    return image;
}

// Pixels in which the two halves of a picture differ, under the captions.
int differing_pixels(const gl::Image& image, const MetricPictureOptions& options) {
    constexpr int kCaption_px = 22;
    const glm::ivec2 half = options.lens.size_px;
    const auto at = [&](int x, int y) {
        return &image.rgb[static_cast<std::size_t>((y * image.size_px.x + x) * 3)];
    };
    int differing = 0;
    for (int y = kCaption_px; y < half.y; ++y)
        for (int x = 0; x < half.x; ++x)
            differing += std::equal(at(x, y), at(x, y) + 3, at(image.size_px.x - half.x + x, y)) ? 0 : 1;
    return differing;
}

MetricSuiteOptions small_suite(const MetricPictureOptions& pictures) {
    MetricSuiteOptions options;
    options.eyes = 9;
    options.columns = 32;
    options.pictures = pictures;
    return options;
}

}  // namespace

TEST_CASE("metric suite: pictures of the size they say, whose halves differ as the metrics do") {
    GlContext gl;
    if (!gl) return;
    const BothMetrics ground;
    const auto options = small_pictures(ground.folder.path());
    MetricSuiteOptions suite = small_suite(options);
    std::int64_t last = 0, all = 0;
    suite.progress = [&](std::int64_t done, std::int64_t total) {
        last = done;
        all = total;
    };
    const auto figures = compare_metrics(*ground.stores[0], *ground.stores[1], suite);
    REQUIRE(figures);
    CHECK(last == all);
    for (int i = 1; i <= 4; ++i) {
        const std::string name = "metric-" + std::to_string(i);
        CAPTURE(name);
        const gl::Image image = load(options.folder / (name + ".png"));
        CHECK(image.size_px == MetricPictures::size_px(options));
        CHECK(differing_pixels(image, options) > options.lens.size_px.x * options.lens.size_px.y / 20);
        const double geometric = *figures->find(name + "/geometric", "triangles");
        CHECK(*figures->find(name + "/cone", "triangles") == doctest::Approx(geometric).epsilon(0.1));
        CHECK(figures->find(name + "/cone", "skyline_px.mean") != nullptr);
    }
}

TEST_CASE("metric pictures: of a store beside itself, both halves are the same") {
    GlContext gl;
    if (!gl) return;
    const BothMetrics ground;
    const auto options = small_pictures(ground.folder.path());
    const auto figures = compare_metrics(*ground.stores[0], *ground.stores[0], small_suite(options));
    REQUIRE(figures);
    CHECK(differing_pixels(load(options.folder / "metric-1.png"), options) == 0);
    CHECK(*figures->find("metric-1/geometric", "skyline_px.mean") ==
          *figures->find("metric-1/cone", "skyline_px.mean"));
}

TEST_CASE("stills: magnified, with the pixel error magnified, the skyline is the same; coarser, it is not") {
    GlContext gl;
    if (!gl) return;
    const BothMetrics ground;
    const io::Store& store = *ground.stores[0];
    SurfaceField source(store);
    REQUIRE(source.take_samples());
    const auto eyes = random_eyes(store.info(), source, 12, 3);
    platform::Camera camera;
    camera.lens.size_px = {200, 150};
    camera.pose = choose_skyline_views(store.info(), source, eyes, {.lens = camera.lens}).at(0);
    jobs::JobSystem jobs({.workers = 1});
    const auto still = [&](int magnification, double pixel_error_px) {
        StillOptions options{.camera = camera, .pixel_error_px = pixel_error_px * magnification};
        options.camera.lens.size_px *= magnification;
        auto taken = take_still(store, jobs, options);
        REQUIRE(taken);
        CHECK(taken->lift_m == 0.0);
        return std::move(*taken);
    };
    const Still plain = still(1, 2.0), large = still(3, 2.0);
    int seen = 0;
    for (std::size_t x = 0; x < plain.skyline.size(); ++x) {
        const int row = plain.skyline[x];
        if (row == 0 || row == plain.image.size_px.y) continue;
        CHECK(std::abs(large.skyline[3 * x + 1] - 3 * row) <= 3);
        ++seen;
    }
    CHECK(seen > 150);
    const auto sum_of_errors = [&](const Still& other) {
        const SkylineDeviation deviation(plain, other);
        return std::accumulate(deviation.errors_px().begin(), deviation.errors_px().end(), 0.0);
    };
    CHECK(sum_of_errors(plain) == 0.0);
    CHECK(sum_of_errors(still(1, 40.0)) > sum_of_errors(still(1, 2.5)));
}

TEST_CASE(
    "pixel error for a number of triangles: draws no fewer, and a little more pixel error draws fewer") {
    const BothMetrics ground;
    const io::Store& store = *ground.stores[0];
    ViewTriangles views(store);
    const platform::Camera camera{
        {{store.info().world(256.0, 480.0), store.info().max_height_m}, Angle(), Angle()}, {}};
    const auto count = [&](double pixel_error_px) { return views.count(camera, pixel_error_px); };
    const double wanted = count(3.0);
    REQUIRE(wanted > count(100.0));
    const double found_px = pixel_error_for(wanted, {0.1, 100.0}, count);
    CHECK(count(found_px) >= wanted);
    CHECK(count(found_px * 1.001) < wanted);
    CHECK(pixel_error_for(0.0, {0.1, 100.0}, count) == 100.0);
}

TEST_CASE("views of the skyline: of different eyes, one low, one high, the skyline in the upper half") {
    const BothMetrics ground;
    const io::TerrainInfo& info = ground.stores[0]->info();
    SurfaceField source(*ground.stores[0]);
    REQUIRE(source.take_samples());
    const auto eyes = random_eyes(info, source, 12, 3);
    platform::Lens lens;
    lens.size_px = {400, 300};
    const auto poses = choose_skyline_views(info, source, eyes, {.lens = lens});
    REQUIRE(poses.size() == 4);
    int low = 0, high = 0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const glm::dvec2 place = info.lattice(poses[i].eye_m.x, poses[i].eye_m.y);
        const double above_m = poses[i].eye_m.z - double{source.at_place(place.x, place.y)};
        low += above_m < 3.0;
        high += above_m > 150.0;
        for (std::size_t k = 0; k < i; ++k) CHECK(poses[i].eye_m != poses[k].eye_m);
        CHECK(std::abs(poses[i].pitch.degrees()) < 30.0);
    }
    CHECK(low >= 1);
    CHECK(high >= 1);
}

TEST_CASE("picture sheet: what is laid stands where it should, what lies outside is cut off") {
    PictureSheet sheet({40, 30}, {255, 255, 255});
    gl::Image red{{10, 10}, {}};
    for (int i = 0; i < 100; ++i) red.rgb.insert(red.rgb.end(), {std::byte{255}, std::byte{0}, std::byte{0}});
    sheet.lay(red, {{2, 2}, {5, 4}}, {37, 28});
    sheet.fill({{-3, -3}, {5, 5}}, {{0, 0, 255}, 0.5});
    const auto pixel = [&](int x, int y) {
        const std::byte* rgb = &sheet.image().rgb[static_cast<std::size_t>((y * 40 + x) * 3)];
        return glm::ivec3(std::to_integer<int>(rgb[0]), std::to_integer<int>(rgb[1]),
                          std::to_integer<int>(rgb[2]));
    };
    CHECK(pixel(36, 28) == glm::ivec3(255));
    CHECK(pixel(37, 28) == glm::ivec3(255, 0, 0));
    CHECK(pixel(39, 29) == glm::ivec3(255, 0, 0));
    CHECK(pixel(1, 1) == glm::ivec3(128, 128, 255));
    CHECK(pixel(2, 2) == glm::ivec3(255));
    sheet.label("Ridge", {4, 4});
    int bright = 0, dark = 0;
    for (int x = 4; x < 40; ++x)
        for (int y = 4; y < 24; ++y) {
            bright += pixel(x, y) == glm::ivec3(255);
            dark += pixel(x, y).x < 128;
        }
    CHECK(bright > 20);
    CHECK(dark > 100);
}
