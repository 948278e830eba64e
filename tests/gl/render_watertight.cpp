// No background ever shows through terrain: random cameras, while tiles stream in late and morph.
//
// A few hundred frames by default, thousands with RIDGELINE_LONG=1.
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <optional>
#include <random>
#include <vector>

#include "gl/render_scene.h"
#include "ridgeline/app/bench/background_pixels.h"
#include "support/drawn_quadtree.h"
#include "support/ray_under_ground.h"

using namespace ridgeline;
using namespace ridgeline::test;

namespace {

constexpr glm::ivec3 kMagenta(255, 0, 255);
// A chunk or two arrive between frames; or nothing for many frames, and then much at once.
constexpr std::chrono::milliseconds kShortDelay{3}, kLongDelay{50};

int frames_to_try() { return std::getenv("RIDGELINE_LONG") ? 2000 : 240; }

double uniform(std::mt19937& random, double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random);
}

glm::ivec2 random_size(std::mt19937& random) {
    const std::vector<glm::ivec2> sizes = {{333, 257}, {400, 300}, {333, 257},
                                           {511, 384}, {640, 480}, {1024, 768}};
    return sizes[random() % (std::getenv("RIDGELINE_LONG") ? sizes.size() : 4)];
}

// Anywhere over the terrain: close to the ground or high, level, grazing or straight down.
platform::Pose random_pose(std::mt19937& random, const RenderScene& scene) {
    const double column = uniform(random, 1.0, static_cast<double>(scene.info().width - 2));
    const double row = uniform(random, 1.0, static_cast<double>(scene.info().height - 2));
    const double above_m = std::exp(uniform(random, std::log(0.5), std::log(300.0)));
    const double pitches[] = {-90.0, uniform(random, -90.0, -40.0), uniform(random, -40.0, 5.0),
                              uniform(random, -8.0, 2.0)};
    return {scene.place(column, row, scene.surface_m(column, row) + above_m),
            Angle::from_degrees(uniform(random, -180.0, 180.0)), Angle::from_degrees(pitches[random() % 4])};
}

// The same pose, somewhat moved: what the next frame of a flight would show.
platform::Pose moved(platform::Pose pose, std::mt19937& random, const RenderScene& scene) {
    pose.heading = pose.heading + Angle::from_degrees(uniform(random, -3.0, 3.0));
    const io::TerrainInfo& info = scene.info();
    const glm::dvec3 step(uniform(random, -3.0, 3.0), uniform(random, -3.0, 3.0), uniform(random, -1.0, 1.0));
    const glm::dvec2 least(info.min_east_m() + 1.0, info.min_north_m() + 1.0);
    const glm::dvec2 most(info.max_east_m() - 1.0, info.max_north_m() - 1.0);
    pose.eye_m = glm::dvec3(glm::clamp(glm::dvec2(pose.eye_m + step), least, most), pose.eye_m.z + step.z);
    return pose;
}

enum class Movement { still, moving };

// Background that terrain follows and whose rays look at the ground as it is drawn. The first alone would
// count the sky between needles, which exaggerated spikes a sample wide are.
int count_cracks(RenderScene& scene, render::Surface surface, const gl::Image& image,
                 const platform::Camera& camera) {
    constexpr double kStep_m = 0.05, kReach_m = 600.0;
    const auto suspects = app::BackgroundPixels(image, kMagenta).wrong(camera);
    if (suspects.empty()) return 0;
    std::optional<DrawnQuadtree> quadtree;
    if (surface == render::Surface::quadtree) quadtree.emplace(scene.stage());
    const auto drawn_m = [&](const glm::dvec2& place_m) -> std::optional<double> {
        if (quadtree) {
            const auto over_eye_m = quadtree->height_m(place_m);
            return over_eye_m ? std::optional(camera.pose.eye_m.z + *over_eye_m) : std::nullopt;
        }
        const auto ground = scene.stage().ground_below(place_m);
        return ground ? std::optional(ground->drawn_m) : std::nullopt;
    };
    return static_cast<int>(std::ranges::count_if(suspects, [&](const glm::ivec2& pixel) {
        return looks_at_ground(camera, pixel, kStep_m, kReach_m, drawn_m);
    }));
}

struct Flight {
    render::Surface surface = render::Surface::mesh;
    int frames = 0, wrong = 0, with_missing = 0, fading = 0, with_made = 0, made_missing = 0;
    // Frames in which chunks and cells met along some border.
    int with_seams = 0;
};

// With places that the chunk beyond has no vertex for.
bool has_seams(const render::MadeRegion& region) {
    return std::ranges::any_of(region.nodes(), [](const render::MadeRegion::Node& node) {
        return std::ranges::any_of(node.seams,
                                   [](const auto& seam) { return seam[0] != 0 && seam[0] != ~0u; });
    });
}

// Short flights from random places, every frame looked at; of a still camera only the tiles' coming and their
// morphs change the picture.
void fly(RenderScene& scene, std::mt19937& random, int frames, double exaggeration, Movement movement,
         Flight& flight) {
    constexpr int kFramesPerPlace = 4;
    const int end = flight.frames + frames;
    app::StageMoment moment;
    moment.exaggeration = exaggeration;
    moment.surface = flight.surface;
    moment.background = render::PlainBackground{255, 0, 255};
    while (flight.frames < end) {
        moment.camera.lens.size_px = random_size(random);
        moment.camera.lens.horizontal_fov = Angle::from_degrees(uniform(random, 30.0, 110.0));
        REQUIRE(scene.stage().resize(moment.camera.lens.size_px));
        moment.camera.pose = random_pose(random, scene);
        for (int i = 0; i < kFramesPerPlace; ++i, ++flight.frames) {
            moment.now += pager::Seconds(0.1);
            const app::StageReport report = scene.stage().show(moment);
            platform::Camera camera = moment.camera;
            camera.pose.eye_m.z += report.eye_lift_m;
            const gl::Image image = gl::read_image(scene.stage().target());
            const int wrong = count_cracks(scene, flight.surface, image, camera);
            if (wrong > 0) {
                INFO("frame ", flight.frames, " pitch ", camera.pose.pitch.degrees(), " above ",
                     camera.pose.eye_m.z);
                CHECK(wrong == 0);
            }
            flight.wrong += wrong;
            const std::size_t missing =
                render::samples_heights(flight.surface) ? report.heights_missing : report.selection.missing;
            if (const render::MadeTiles* made = scene.stage().frame().made_tiles()) {
                flight.with_made += made->counters().held > 0 ? 1 : 0;
                flight.with_seams += has_seams(scene.stage().frame().made_region()) ? 1 : 0;
                flight.made_missing += made->counters().missing > 0 ? 1 : 0;
            }
            flight.with_missing += missing > 0 ? 1 : 0;
            flight.fading += scene.stage().pager().fading() ? 1 : 0;
            if (movement == Movement::moving) moment.camera.pose = moved(moment.camera.pose, random, scene);
        }
    }
}

// A pixel error of 1 on so small a terrain is the finest level everywhere; coarser ones make levels meet and
// morph.
SceneOptions streaming_scene(double pixel_error, std::chrono::milliseconds delay) {
    SceneOptions options;
    options.stage.pixel_error = pixel_error;
    options.stage.pager.fault.delay = delay;
    // Too small for all of it: chunks come and go.
    options.stage.pager.ram_bytes = 2_MiB;
    options.stage.frame.gpu_cache_bytes = 3_MiB;
    return options;
}

// Heights beside the chunks need room for their level 0.
SceneOptions streaming_disc(double pixel_error, std::chrono::milliseconds delay) {
    SceneOptions options = streaming_scene(pixel_error, delay);
    options.stage.frame.surfaces = render::Surfaces::all;
    return options;
}

}  // namespace

namespace {

using Streaming = SceneOptions (*)(double pixel_error, std::chrono::milliseconds delay);

// Still and moving cameras, with a little and with much coming at a time.
void fly_while_streaming(RenderScene& scene, Streaming streaming, std::initializer_list<double> pixel_errors,
                         std::mt19937& random, Flight& flight) {
    for (const double pixel_error : pixel_errors)
        for (const auto delay : {kShortDelay, kLongDelay})
            for (const Movement movement : {Movement::still, Movement::moving}) {
                CAPTURE(pixel_error);
                scene.open(streaming(pixel_error, delay).stage);
                fly(scene, random, frames_to_try() / 16, 1.0, movement, flight);
            }
    CHECK(flight.wrong == 0);
    // The test would prove little if nothing were late.
    CHECK(flight.with_missing > flight.frames / 10);
}

// Terrain that does not fill its nodes.
void fly_exaggerated(SceneOptions options, unsigned seed, Flight flight) {
    std::mt19937 random(seed);
    options.width = 300;
    options.height = 211;
    RenderScene scene(options);
    fly(scene, random, frames_to_try() / 4, 2.5, Movement::moving, flight);
    CHECK(flight.wrong == 0);
}

}  // namespace

TEST_CASE("No background shows through the disc while heights stream in late and fade in") {
    GlContext gl;
    if (!gl) return;
    std::mt19937 random(20260612);
    SceneOptions options = streaming_disc(1.0, kShortDelay);
    // Larger than the innermost ring: rings meet.
    options.width = options.height = 513;
    RenderScene scene(options);
    Flight flight{.surface = render::Surface::disc};
    fly_while_streaming(scene, streaming_disc, {1.0, 5.0}, random, flight);
}

TEST_CASE("No background shows through an exaggerated disc over terrain that does not fill its nodes") {
    GlContext gl;
    if (!gl) return;
    fly_exaggerated(streaming_disc(2.0, kShortDelay), 8, {.surface = render::Surface::disc});
}

TEST_CASE("The quadtree as it is read back stands at the terrain's own heights where it is finest") {
    GlContext gl;
    if (!gl) return;
    SceneOptions options = streaming_disc(0.05, kShortDelay);
    options.stage.wait = app::TileWait::settle;
    RenderScene scene(options);
    app::StageMoment moment;
    moment.surface = render::Surface::quadtree;
    moment.camera.pose = {scene.place(128, 120, 60.0), Angle(), Angle::from_degrees(-70.0)};
    scene.stage().show(moment);
    DrawnQuadtree quadtree(scene.stage());
    int finest = 0;
    for (int row = 118; row < 124; ++row)
        for (int column = 124; column < 132; ++column) {
            const auto over_eye_m = quadtree.height_m(glm::dvec2(scene.place(column, row, 0.0)));
            REQUIRE(over_eye_m.has_value());
            finest += std::abs(60.0 + *over_eye_m - scene.surface_m(column, row)) < 1e-3 ? 1 : 0;
        }
    CHECK(finest > 40);
    CHECK_FALSE(quadtree.height_m(glm::dvec2(scene.place(-1, 5, 0.0))).has_value());
}

TEST_CASE("No background shows through the quadtree while heights stream in late and fade in") {
    GlContext gl;
    if (!gl) return;
    std::mt19937 random(20261127);
    SceneOptions options = streaming_disc(1.0, kShortDelay);
    options.width = options.height = 513;
    RenderScene scene(options);
    Flight flight{.surface = render::Surface::quadtree};
    fly_while_streaming(scene, streaming_disc, {1.0, 5.0}, random, flight);
}

// Down to half a metre over it, so that all octaves are drawn; a quarter of the flights is above all of them.
TEST_CASE("No background shows through made ground while it is made and fades in") {
    GlContext gl;
    if (!gl) return;
    struct Made {
        render::Surface surface;
        int octaves;
    };
    // Of eight, cells of the finest lie beside chunks eight levels coarser.
    for (const Made& drawn : {Made{render::Surface::mesh, 3},
                              {render::Surface::mesh, 8},
                              {render::Surface::disc, 3},
                              {render::Surface::quadtree, 3}}) {
        CAPTURE(static_cast<int>(drawn.surface));
        std::mt19937 random(20261128);
        SceneOptions options = streaming_disc(1.0, kShortDelay);
        options.stage.frame.detail_octaves = drawn.octaves;
        RenderScene scene(options);
        Flight flight{.surface = drawn.surface};
        fly(scene, random, frames_to_try() / 4, 1.0, Movement::moving, flight);
        CHECK(flight.wrong == 0);
        CHECK(flight.with_made > flight.frames / 2);
        CHECK(flight.made_missing > flight.frames / 10);
        if (drawn.surface == render::Surface::mesh) CHECK(flight.with_seams > flight.frames / 4);
    }
}

TEST_CASE("No background shows through an exaggerated quadtree over terrain that does not fill its nodes") {
    GlContext gl;
    if (!gl) return;
    fly_exaggerated(streaming_disc(2.0, kShortDelay), 9, {.surface = render::Surface::quadtree});
}

TEST_CASE("No background shows through terrain while tiles stream in late and morph") {
    GlContext gl;
    if (!gl) return;
    std::mt19937 random(20260611);
    RenderScene scene(streaming_scene(1.0, kShortDelay));
    Flight flight;
    fly_while_streaming(scene, streaming_scene, {1.0, 5.0, 12.0, 30.0}, random, flight);
    CHECK(flight.fading > flight.frames / 10);
}

TEST_CASE("No background shows through exaggerated terrain that does not fill its nodes") {
    GlContext gl;
    if (!gl) return;
    fly_exaggerated(streaming_scene(10.0, kShortDelay), 7, {});
}
