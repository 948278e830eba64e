// What the horizon leaves out is not in the picture: with it and without it, every pixel is the same.
//
// Small rugged terrain by default, with and without holes; with RIDGELINE_LONG=1 also a thousand views and
// two walks over each of a synthetic terrain and of what real ones the data holds.
#include <algorithm>
#include <cstdlib>
#include <random>

#include "gl/render_scene.h"
#include "ridgeline/app/bench/horizon_walks.h"
#include "ridgeline/app/walk/course.h"
#include "ridgeline/synth/synth.h"
#include "support/built_store.h"
#include "support/data.h"
#include "unit/build_fixture.h"

using namespace ridgeline;
using namespace ridgeline::test;

namespace {

using select::HorizonMode;

bool is_long() { return std::getenv("RIDGELINE_LONG") != nullptr; }

double uniform(std::mt19937& random, double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random);
}

constexpr glm::ivec2 kSmall_px(400, 300), kUsual_px(1024, 768);

app::StageOptions settled(const glm::ivec2& size_px, HorizonMode horizon, double pixel_error) {
    app::StageOptions options;
    options.frame.size_px = size_px;
    options.wait = app::TileWait::settle;
    options.horizon = horizon;
    options.pixel_error = pixel_error;
    return options;
}

// From a man's height to five kilometres, mostly near the ground; any pitch, mostly level; one in eight
// stands beside the terrain and looks anywhere.
app::StageMoment random_moment(std::mt19937& random, const io::Store& store, app::TerrainStage& stage) {
    const io::TerrainInfo& info = store.info();
    app::StageMoment moment;
    moment.exaggeration = random() % 4 == 0 ? 2.0 : 1.0;
    moment.camera.lens.size_px = kSmall_px;
    moment.camera.lens.horizontal_fov = Angle::from_degrees(uniform(random, 20.0, 120.0));
    const double aside = random() % 8 == 0 ? -0.1 : 0.0;
    const glm::dvec2 place =
        info.world(uniform(random, aside, 1.0 - aside) * static_cast<double>(info.width - 1),
                   uniform(random, aside, 1.0 - aside) * static_cast<double>(info.height - 1));
    const double highest_m = random() % 4 == 0 ? 5000.0 : 300.0;
    const double above_m = std::exp(uniform(random, std::log(1.5), std::log(highest_m)));
    moment.camera.pose = {
        glm::dvec3(place, 0.0), Angle::from_degrees(uniform(random, -180.0, 180.0)),
        Angle::from_degrees(random() % 5 == 0 ? uniform(random, -90.0, 90.0) : uniform(random, -15.0, 8.0))};
    // The stage lifts an eye under the ground to one metre over it.
    moment.camera.pose.eye_m.z = info.min_height_m * moment.exaggeration - 10.0;
    const double lift_m = stage.show(moment).eye_lift_m;
    moment.camera.pose.eye_m.z += lift_m + above_m;
    moment.speed_m_per_s = uniform(random, 0.0, 60.0);
    return moment;
}

// How many pixels differ, and where the first of them is.
std::string difference(const gl::Image& a, const gl::Image& b) {
    std::size_t pixels = 0, first = 0;
    for (std::size_t i = 0; i < a.rgb.size(); i += 3)
        if (!std::equal(a.rgb.begin() + static_cast<std::ptrdiff_t>(i),
                        a.rgb.begin() + static_cast<std::ptrdiff_t>(i) + 3,
                        b.rgb.begin() + static_cast<std::ptrdiff_t>(i)) &&
            pixels++ == 0)
            first = i / 3;
    const auto width = static_cast<std::size_t>(a.size_px.x);
    return std::to_string(pixels) + " pixels, the first at column " + std::to_string(first % width) +
           ", row " + std::to_string(first / width);
}

struct Tally {
    int views = 0, different = 0, lifted = 0;
    std::uint64_t hidden = 0, triangles = 0, all_triangles = 0;
};

// The same moments with and without the horizon.
class TwoStages {
  public:
    TwoStages(const io::Store& store, jobs::JobSystem& jobs, const glm::ivec2& size_px, HorizonMode horizon,
              double pixel_error) {
        plain_ = open(store, jobs, settled(size_px, HorizonMode::off, pixel_error));
        culling_ = open(store, jobs, settled(size_px, horizon, pixel_error));
    }

    app::TerrainStage& plain() { return *plain_; }

    void compare(const app::StageMoment& moment, Tally& tally) {
        tally.all_triangles += plain_->show(moment).surface.triangles;
        const gl::Image all = gl::read_image(plain_->target());
        const app::StageReport report = culling_->show(moment);
        tally.triangles += report.surface.triangles;
        tally.hidden += report.selection.horizon_culled;
        tally.lifted += report.eye_lift_m > 0.0 ? 1 : 0;
        const int number = tally.views++;
        const gl::Image culled = gl::read_image(culling_->target());
        if (culled.rgb == all.rgb) return;
        ++tally.different;
        const platform::Pose& pose = moment.camera.pose;
        MESSAGE("view ", number, " differs in ", difference(all, culled), ": eye ", pose.eye_m.x, " ",
                pose.eye_m.y, " ", pose.eye_m.z, " heading ", pose.heading.degrees(), " pitch ",
                pose.pitch.degrees());
    }

  private:
    static std::unique_ptr<app::TerrainStage> open(const io::Store& store, jobs::JobSystem& jobs,
                                                   const app::StageOptions& options) {
        auto stage = app::TerrainStage::create(store, jobs, options);
        REQUIRE_MESSAGE(stage.ok(), (stage.ok() ? "" : stage.error().message));
        return std::move(stage).value();
    }

    std::unique_ptr<app::TerrainStage> plain_, culling_;
};

void compare_views(const io::Store& store, jobs::JobSystem& jobs, HorizonMode horizon, double pixel_error,
                   int views, std::mt19937& random, Tally& tally) {
    TwoStages stages(store, jobs, kSmall_px, horizon, pixel_error);
    for (int i = 0; i < views; ++i) stages.compare(random_moment(random, store, stages.plain()), tally);
}

// Every frame of a walk.
void compare_walk(const io::Store& store, jobs::JobSystem& jobs, const platform::ResolvedPath& path,
                  Tally& tally) {
    TwoStages stages(store, jobs, kUsual_px, HorizonMode::ridges, 1.0);
    app::Course course(path, path.frame(0));
    for (std::int64_t i = 0; i < static_cast<std::int64_t>(path.frame_count()); ++i) {
        course.show_frame(i);
        app::StageMoment moment;
        moment.number = static_cast<std::uint64_t>(i);
        moment.camera.pose = course.pose();
        moment.camera.lens.size_px = kUsual_px;
        moment.speed_m_per_s = course.speed_m_per_s();
        moment.turn_per_second = course.turn_per_second();
        moment.now = app::kHeadlessFrameTime * static_cast<double>(i);
        stages.compare(moment, tally);
    }
}

void report(const std::string& name, const Tally& tally) {
    MESSAGE(name, ": ", tally.views, " views, ", tally.hidden, " hidden leaves, triangles ", tally.triangles,
            " of ", tally.all_triangles);
    CHECK(tally.different == 0);
    CHECK(tally.hidden > 0);
}

void prove_at_length(const io::Store& store, const std::string& name) {
    jobs::JobSystem jobs({.workers = 1});
    std::mt19937 random(4);
    Tally views;
    compare_views(store, jobs, HorizonMode::ridges, 1.0, 1000, random, views);
    report(name + ", random", views);
    const auto ground = app::resolve_course(store, {.kind = app::PathChoice::Kind::ground, .file = {}}, 1.0);
    REQUIRE(ground.ok());
    Tally walk, look;
    compare_walk(store, jobs, *ground, walk);
    report(name + ", walk", walk);
    // Two metres over the ground with all its tiles there.
    CHECK(walk.lifted == 0);
    compare_walk(store, jobs, app::looking_about(*ground), look);
    report(name + ", looking about", look);
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
            compare_views(scene.store(), jobs, horizon, pixel_error, views, random, tally);
    report("rugged", tally);
}

TEST_CASE("Beside holes the horizon changes no pixel") {
    GlContext gl;
    if (!gl) return;
    const ScratchFolder folder;
    const auto place = folder.path() / "holes.terrain";
    MemoryRows rows(400, 380, with_voids(rugged_quanta, 400, 3));
    build::BuildOptions options;
    options.out = place;
    options.tile = 33;
    REQUIRE(build::build_from_rows(rows, options));
    const auto store = io::Store::open(place);
    REQUIRE(store.ok());
    std::mt19937 random(5);
    jobs::JobSystem jobs({.workers = 1});
    Tally tally;
    const int views = is_long() ? 500 : 25;
    for (const double pixel_error : {1.0, 6.0})
        compare_views(*store, jobs, HorizonMode::ridges, pixel_error, views, random, tally);
    report("holes", tally);
}

TEST_CASE("On synthetic mountains the horizon changes no pixel" * doctest::skip(!is_long())) {
    GlContext gl;
    if (!gl) return;
    const ScratchFolder folder;
    synth::SynthOptions options;
    options.path = folder.path() / "mountains.tif";
    jobs::JobSystem jobs;
    REQUIRE(synth::synth(options, jobs));
    prove_at_length(built_store(options.path, folder.path() / "mountains.terrain"), "synth 8193");
}

TEST_CASE("On real mountains the horizon changes no pixel" * doctest::skip(!is_long())) {
    GlContext gl;
    if (!gl) return;
    const ScratchFolder folder;
    for (const char* name : {"taiwan_central_8k.tif", "voids/alps_N46E008_voids.tif"}) {
        const auto source = data_file(name);
        if (source.empty()) continue;
        prove_at_length(built_store(source.string(), folder.path() / (source.stem().string() + ".terrain")),
                        name);
    }
}
