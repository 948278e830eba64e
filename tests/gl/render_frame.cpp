// The frame as a picture: where things are, its size, its background, its budgets.
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <random>

#include "gl/render_scene.h"
#include "ridgeline/app/bench/background_pixels.h"
#include "ridgeline/base/whole_file.h"
#include "ridgeline/io/terrain_info.h"

using namespace ridgeline;
using namespace ridgeline::test;

namespace {

SceneOptions settled_scene(const glm::ivec2& size_px) {
    SceneOptions options;
    options.stage.frame.size_px = size_px;
    options.stage.wait = app::TileWait::settle;
    return options;
}

app::StageMoment look(const glm::dvec3& eye_m, double heading_deg, double pitch_deg,
                      const glm::ivec2& size_px) {
    app::StageMoment moment;
    moment.camera.lens.size_px = size_px;
    moment.camera.pose = {eye_m, Angle::from_degrees(heading_deg), Angle::from_degrees(pitch_deg)};
    return moment;
}

glm::ivec3 pixel(const gl::Image& image, int x, int y) {
    REQUIRE((x >= 0 && y >= 0 && x < image.size_px.x && y < image.size_px.y));
    const std::size_t at = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.size_px.x) +
                                static_cast<std::size_t>(x));
    return {std::to_integer<int>(image.rgb[at]), std::to_integer<int>(image.rgb[at + 1]),
            std::to_integer<int>(image.rgb[at + 2])};
}

// The pixel in which a world point appears.
glm::ivec2 project(const platform::Camera& camera, const glm::dvec3& point_m) {
    const glm::dvec4 clip =
        platform::clip_from_eye_world(camera) * glm::dvec4(point_m - camera.pose.eye_m, 1.0);
    const glm::dvec2 ndc = glm::dvec2(clip) / clip.w;
    const glm::dvec2 size(camera.lens.size_px);
    return glm::ivec2((0.5 + 0.5 * ndc.x) * size.x, (0.5 - 0.5 * ndc.y) * size.y);
}

}  // namespace

TEST_CASE("The terrain's corners appear where the camera says they are") {
    GlContext gl;
    if (!gl) return;
    constexpr glm::ivec2 kSize(601, 451);
    RenderScene scene(settled_scene(kSize));
    // From above, a little askew, so that no two corners could be exchanged.
    auto moment = look(scene.place(110, 140, 330.0), 17.0, -90.0, kSize);
    moment.camera.lens.horizontal_fov = Angle::from_degrees(100.0);
    moment.background = render::PlainBackground{255, 0, 255};
    scene.stage().show(moment);
    const gl::Image image = gl::read_image(scene.stage().target());
    REQUIRE(image.size_px == kSize);
    for (const double column : {0.0, 256.0})
        for (const double row : {0.0, 256.0}) {
            const glm::dvec2 inwards(column > 0.0 ? -6.0 : 6.0, row > 0.0 ? -6.0 : 6.0);
            const auto corner = scene.place(column, row, scene.surface_m(column, row));
            const auto inside = project(moment.camera, corner + glm::dvec3(inwards.x, -inwards.y, 0.0));
            const auto outside = project(moment.camera, corner - glm::dvec3(inwards.x, -inwards.y, 0.0));
            CAPTURE(column);
            CAPTURE(row);
            CHECK(pixel(image, inside.x, inside.y) != glm::ivec3(255, 0, 255));
            CHECK(pixel(image, outside.x, outside.y) == glm::ivec3(255, 0, 255));
        }
}

TEST_CASE("Light comes from the sun's side") {
    GlContext gl;
    if (!gl) return;
    constexpr glm::ivec2 kSize(320, 240);
    RenderScene scene(settled_scene(kSize));
    auto moment = look(scene.place(128, 128, 300.0), 0.0, -90.0, kSize);
    const auto brightness = [&](double azimuth_deg, double column, double row) {
        moment.daylight = {Angle::from_degrees(azimuth_deg), Angle::from_degrees(25.0)};
        scene.stage().show(moment);
        const auto at = project(moment.camera, scene.place(column, row, scene.surface_m(column, row)));
        const auto rgb = pixel(gl::read_image(scene.stage().target()), at.x, at.y);
        return rgb.r + rgb.g + rgb.b;
    };
    // The steepest slope to the east and to the west among the samples about the middle.
    glm::dvec2 east_slope(0.0), west_slope(0.0);
    double steepest_east = 0.0, steepest_west = 0.0;
    for (int row = 100; row < 156; ++row)
        for (int column = 100; column < 156; ++column) {
            const double fall = (scene.surface_m(column - 3, row) - scene.surface_m(column + 3, row)) / 6.0;
            if (fall > steepest_east) steepest_east = fall, east_slope = {column, row};
            if (-fall > steepest_west) steepest_west = -fall, west_slope = {column, row};
        }
    CHECK(brightness(90.0, east_slope.x, east_slope.y) > brightness(270.0, east_slope.x, east_slope.y));
    CHECK(brightness(270.0, west_slope.x, west_slope.y) > brightness(90.0, west_slope.x, west_slope.y));
}

TEST_CASE("No ground has exactly the colour of the background") {
    GlContext gl;
    if (!gl) return;
    constexpr glm::ivec2 kSize(200, 150);
    RenderScene scene(settled_scene(kSize));
    // Straight down from near: nothing but ground.
    auto moment = look(scene.place(128, 128, 60.0), 0.0, -90.0, kSize);
    moment.background = render::PlainBackground{1, 2, 3};
    scene.stage().show(moment);
    const gl::Image plain = gl::read_image(scene.stage().target());
    for (int i = 0; i < 40; ++i) {
        const glm::ivec3 color = pixel(plain, (i * 37) % kSize.x, (i * 53) % kSize.y);
        moment.background =
            render::PlainBackground{static_cast<std::uint8_t>(color.r), static_cast<std::uint8_t>(color.g),
                                    static_cast<std::uint8_t>(color.b)};
        scene.stage().show(moment);
        CHECK(app::BackgroundPixels(gl::read_image(scene.stage().target()), color).count() == 0);
    }
}

TEST_CASE("The same frame comes out the same, pixel by pixel") {
    GlContext gl;
    if (!gl) return;
    constexpr glm::ivec2 kSize(320, 200);
    const SceneOptions options = settled_scene(kSize);
    RenderScene scene(options);
    const auto first = look(scene.place(60, 220, 70.0), 30.0, -12.0, kSize);
    const auto second = look(scene.place(200, 40, 90.0), 200.0, -20.0, kSize);
    scene.stage().show(first);
    const gl::Image image = gl::read_image(scene.stage().target());
    scene.stage().show(second);
    scene.stage().show(first);
    CHECK(gl::read_image(scene.stage().target()).rgb == image.rgb);
    scene.open(options.stage);
    scene.stage().show(first);
    CHECK(gl::read_image(scene.stage().target()).rgb == image.rgb);
}

TEST_CASE("Ten thousand kilometres from the origin the same ground gives the same picture, step by step") {
    GlContext gl;
    if (!gl) return;
    constexpr glm::ivec2 kSize(160, 120);
    // Whole repeats of the ground's noise, which lies fixed in the world; a float is off by a metre there.
    constexpr double kFar_m = 29.0 * 911.0 * 378.0;
    SceneOptions options = settled_scene(kSize);
    RenderScene near(options);
    options.finish_store = [](const std::filesystem::path& store) {
        auto info = io::read_terrain_info(store);
        REQUIRE(info);
        info->west_m += kFar_m;
        info->north_m += kFar_m;
        REQUIRE(write_whole_file(store / io::kInfoFile, io::to_json(*info)));
    };
    RenderScene far(options);
    for (int step = 0; step < 8; ++step) {
        // Steps of a thirty-second of a metre, close over the ground, where anything that trembles shows.
        auto moment =
            look(near.place(120, 140, 45.0) + glm::dvec3(step / 32.0, 0.0, 0.0), 30.0, -25.0, kSize);
        near.stage().show(moment);
        moment.camera.pose.eye_m += glm::dvec3(kFar_m, kFar_m, 0.0);
        far.stage().show(moment);
        const gl::Image here = gl::read_image(near.stage().target());
        const gl::Image there = gl::read_image(far.stage().target());
        // Where in the noise the eye stands is rounded at another bit: a step of 255, here and there.
        int most = 0, different = 0;
        for (std::size_t i = 0; i < here.rgb.size(); ++i) {
            const int off = std::abs(std::to_integer<int>(here.rgb[i]) - std::to_integer<int>(there.rgb[i]));
            most = std::max(most, off);
            different += off != 0;
        }
        CHECK(most <= 1);
        CHECK(different < static_cast<int>(here.rgb.size()) / 100);
    }
}

TEST_CASE("GPU slots keep to their bytes and refuse what level 0 does not fit") {
    GlContext gl;
    if (!gl) return;
    SceneOptions options = settled_scene({160, 120});
    options.stage.frame.gpu_cache_bytes = 2_MiB;
    options.stage.pixel_error = 0.2;
    RenderScene scene(options);
    CHECK(scene.stage().gpu_cache_capacity_bytes() <= 1_MiB);
    for (int i = 0; i < 12; ++i) {
        scene.stage().show(look(scene.place(20.0 * i + 10.0, 128, 60.0), 30.0 * i, -20.0, {160, 120}));
        CHECK(scene.stage().gpu_cache_bytes() <= 1_MiB);
    }
    jobs::JobSystem jobs{{.workers = 1}};
    options.stage.frame.gpu_cache_bytes = 4_KiB;
    const auto refused = app::TerrainStage::create(scene.store(), jobs, options.stage);
    REQUIRE(!refused.ok());
    CHECK(refused.error().message.find("--gpu-cache") != std::string::npos);
}

namespace {

// Shows the same frame until nothing more can come, at most for a minute.
bool comes_to_rest(app::TerrainStage& stage, app::StageMoment& moment) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    do {
        ++moment.number;
        moment.now += pager::Seconds(1.0);
        stage.show(moment);
        if (stage.pager().settled()) return true;
    } while (std::chrono::steady_clock::now() < end);
    return false;
}

}  // namespace

TEST_CASE("With the camera at rest uploads end, whatever the GPU cache holds") {
    GlContext gl;
    if (!gl) return;
    constexpr glm::ivec2 kSmall(64, 48);
    SceneOptions options;
    options.width = options.height = 513;
    options.stage.frame.size_px = kSmall;
    options.stage.pixel_error = 0.1;
    RenderScene scene(options);
    std::mt19937 random(1);
    const auto within = [&](double least, double most) {
        return std::uniform_real_distribution(least, most)(random);
    };
    for (int cache = 0; cache < 40; ++cache) {
        options.stage.frame.gpu_cache_bytes = static_cast<std::uint64_t>(within(0.2, 3.0) * (1 << 20));
        CAPTURE(options.stage.frame.gpu_cache_bytes);
        scene.open(options.stage);
        for (int place = 0; place < 2; ++place) {
            auto moment = look(scene.place(within(0.0, 512.0), within(0.0, 512.0), within(60.0, 300.0)),
                               within(0.0, 360.0), within(-60.0, 0.0), kSmall);
            REQUIRE(comes_to_rest(scene.stage(), moment));
            for (int frame = 0; frame < 8; ++frame) {
                ++moment.number;
                REQUIRE(scene.stage().show(moment).bytes_uploaded == 0);
            }
        }
    }
}

TEST_CASE("A frame that waits for its tiles waits no longer once the walk is to end") {
    GlContext gl;
    if (!gl) return;
    const std::atomic<bool> stop = true;
    SceneOptions options;
    options.stage.wait = app::TileWait::settle;
    options.stage.stop = &stop;
    options.stage.pager.fault.delay = std::chrono::hours(1);
    RenderScene scene(options);
    app::StageMoment moment;
    moment.camera.pose.eye_m = scene.place(128.0, 128.0, 75.0);
    CHECK(scene.stage().show(moment).selection.missing > 0);
}
