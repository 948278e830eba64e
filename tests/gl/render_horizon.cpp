// What the horizon leaves out is not in the picture: with it and without it, every pixel is the same.
//
// Rugged small terrain by default; with RIDGELINE_LONG=1 also a thousand views of real mountains, where the
// data is.
#include <cstdlib>
#include <random>

#include "gl/render_scene.h"
#include "ridgeline/build/builder.h"
#include "support/data.h"

using namespace ridgeline;
using namespace ridgeline::test;

namespace {

using select::HorizonMode;

bool is_long() { return std::getenv("RIDGELINE_LONG") != nullptr; }

double uniform(std::mt19937& random, double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random);
}

app::StageOptions settled(HorizonMode horizon, double pixel_error) {
    app::StageOptions options;
    options.frame.size_px = {400, 300};
    options.wait = app::TileWait::settle;
    options.horizon = horizon;
    options.pixel_error = pixel_error;
    return options;
}

// Over the terrain, mostly close to the ground, looking anywhere but mostly level.
app::StageMoment random_moment(std::mt19937& random, const io::Store& store, app::TerrainStage& stage) {
    const io::TerrainInfo& info = store.info();
    app::StageMoment moment;
    moment.exaggeration = random() % 4 == 0 ? 2.0 : 1.0;
    moment.camera.lens.size_px = {400, 300};
    moment.camera.lens.horizontal_fov = Angle::from_degrees(uniform(random, 20.0, 120.0));
    const glm::dvec2 place = info.world(uniform(random, 0.02, 0.98) * static_cast<double>(info.width - 1),
                                        uniform(random, 0.02, 0.98) * static_cast<double>(info.height - 1));
    const double above_m = std::exp(uniform(random, std::log(1.5), std::log(300.0)));
    moment.camera.pose = {
        glm::dvec3(place, 0.0), Angle::from_degrees(uniform(random, -180.0, 180.0)),
        Angle::from_degrees(random() % 5 == 0 ? uniform(random, -90.0, 40.0) : uniform(random, -15.0, 8.0))};
    // The stage lifts an eye under the ground to one metre over it.
    moment.camera.pose.eye_m.z = info.min_height_m * moment.exaggeration - 10.0;
    const double lift_m = stage.show(moment).eye_lift_m;
    moment.camera.pose.eye_m.z += lift_m + above_m;
    moment.speed_m_per_s = uniform(random, 0.0, 60.0);
    return moment;
}

struct Tally {
    int views = 0, different = 0;
    std::uint64_t hidden = 0, triangles = 0, all_triangles = 0;
};

void compare(const io::Store& store, jobs::JobSystem& jobs, HorizonMode horizon, double pixel_error,
             int views, std::mt19937& random, Tally& tally) {
    auto plain = app::TerrainStage::create(store, jobs, settled(HorizonMode::off, pixel_error));
    auto culling = app::TerrainStage::create(store, jobs, settled(horizon, pixel_error));
    REQUIRE(plain.ok());
    REQUIRE(culling.ok());
    for (int i = 0; i < views; ++i, ++tally.views) {
        const app::StageMoment moment = random_moment(random, store, **plain);
        tally.all_triangles += (*plain)->show(moment).surface.triangles;
        const gl::Image all = gl::read_image((*plain)->target());
        const app::StageReport report = (*culling)->show(moment);
        tally.triangles += report.surface.triangles;
        tally.hidden += report.selection.horizon_culled;
        if (gl::read_image((*culling)->target()).rgb == all.rgb) continue;
        ++tally.different;
        const platform::Pose& pose = moment.camera.pose;
        MESSAGE("view ", i, " differs: eye ", pose.eye_m.x, " ", pose.eye_m.y, " ", pose.eye_m.z, " heading ",
                pose.heading.degrees(), " pitch ", pose.pitch.degrees());
    }
}

void report(const Tally& tally) {
    MESSAGE(tally.views, " views, ", tally.hidden, " hidden leaves, triangles ", tally.triangles, " of ",
            tally.all_triangles);
}

}  // namespace

TEST_CASE("On small rugged terrain the horizon changes no pixel") {
    GlContext gl;
    if (!gl) return;
    std::mt19937 random(3);
    SceneOptions options;
    options.width = 300;
    options.height = 257;
    options.stage.wait = app::TileWait::settle;
    RenderScene scene(options);
    jobs::JobSystem jobs({.workers = 1});
    Tally tally;
    const int views = is_long() ? 300 : 25;
    for (const double pixel_error : {1.0, 6.0})
        for (const HorizonMode horizon : {HorizonMode::ridges, HorizonMode::boxes})
            compare(scene.store(), jobs, horizon, pixel_error, views, random, tally);
    report(tally);
    CHECK(tally.different == 0);
    CHECK(tally.hidden > 0);
}

TEST_CASE("On real mountains the horizon changes no pixel" * doctest::skip(!is_long())) {
    GlContext gl;
    if (!gl) return;
    const auto source = data_file("taiwan_2k.tif");
    if (source.empty()) return;
    const auto place = std::filesystem::temp_directory_path() / "ridgeline-test-horizon.terrain";
    build::BuildOptions build;
    build.sources = {source.string()};
    build.out = place;
    build.replace = io::Replace::existing;
    REQUIRE(build::build_terrain(build));
    auto store = io::Store::open(place);
    REQUIRE(store.ok());
    std::mt19937 random(4);
    jobs::JobSystem jobs({.workers = 1});
    Tally tally;
    compare(*store, jobs, HorizonMode::ridges, 1.0, 1000, random, tally);
    report(tally);
    CHECK(tally.different == 0);
    CHECK(tally.hidden > 1000);
    std::filesystem::remove_all(place);
}
