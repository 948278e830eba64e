// All surfaces show the same land: pictures of disc and quadtree held against the mesh's, over terrain of
// every awkward shape; and their own promises that need pictures.
//
// The surfaces are no copies of each other (sampled heights are filtered to the vertices' spacing), so
// pictures differ a little everywhere; what must agree closely is where there is ground at all, and the light
// on average.
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <random>

#include "gl/render_scene.h"
#include "ridgeline/build/builder.h"
#include "support/small_imagery.h"
#include "unit/build_fixture.h"

using namespace ridgeline;
using namespace ridgeline::test;

namespace {

constexpr glm::ivec2 kSize(320, 240);
constexpr render::PlainBackground kMagenta{255, 0, 255};

double uniform(std::mt19937& random, double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random);
}

// Hills and dales that no filter of two samples' width levels. Half metres.
std::int32_t hills(std::int64_t x, std::int64_t y) {
    const double u = static_cast<double>(x), v = static_cast<double>(y);
    return static_cast<std::int32_t>(std::lround(160.0 * std::sin(u * 0.031 + 0.7 * std::sin(v * 0.023)) +
                                                 90.0 * std::cos(v * 0.047 + u * 0.011) +
                                                 14.0 * std::sin(u * 0.21) * std::sin(v * 0.17)));
}
std::int32_t with_lakes(std::int64_t x, std::int64_t y) {
    const auto dx = static_cast<double>(x % 90 - 45), dy = static_cast<double>(y % 70 - 35);
    return std::hypot(dx, dy) < 17.0 ? build::kNoHeight : hills(x, y);
}
// Whole roots of 33 samples at level 0 are empty, and others partly.
std::int32_t with_wastes(std::int64_t x, std::int64_t y) {
    return x > 150 && x < 420 ? build::kNoHeight : hills(x, y);
}

struct Land {
    const char* name = "";
    std::int64_t width = 257, height = 257;
    std::int32_t (*quanta)(std::int64_t x, std::int64_t y) = hills;
};
// One root, filled and not; smaller than a tile; several roots, empty ones among them; holes.
constexpr Land kLands[] = {
    {"filled", 257, 257, hills},          {"odd", 300, 211, hills},           {"tiny", 21, 17, hills},
    {"two samples wide", 2, 90, hills},   {"several roots", 700, 140, hills}, {"lakes", 300, 260, with_lakes},
    {"empty roots", 700, 90, with_wastes}};

class Gallery {
  public:
    using Finish = std::function<void(const std::filesystem::path& store)>;
    // finish: called before the store is opened; may be empty.
    explicit Gallery(const Land& land, const app::StageOptions& options = {}, const Finish& finish = {}) {
        MemoryRows rows(land.width, land.height, land.quanta);
        build::BuildOptions build_options;
        build_options.out = folder_.path() / "land.terrain";
        build_options.tile = 33;
        REQUIRE(build::build_from_rows(rows, build_options));
        if (finish) finish(build_options.out);
        auto store = io::Store::open(build_options.out);
        REQUIRE(store);
        store_ = std::make_unique<io::Store>(std::move(store).value());
        open(options);
    }

    void open(app::StageOptions options) {
        options.frame.size_px = kSize;
        options.frame.surfaces = render::Surfaces::all;
        options.wait = app::TileWait::settle;
        stage_.reset();
        auto stage = app::TerrainStage::create(*store_, jobs_, options);
        REQUIRE_MESSAGE(stage.ok(), (stage.ok() ? "" : stage.error().message));
        stage_ = std::move(stage).value();
    }

    gl::Image take(app::StageMoment moment, render::Surface surface) {
        moment.surface = surface;
        report_ = stage_->show(moment);
        return gl::read_image(stage_->target());
    }

    // Over the land, from a man's height to where all of it is seen.
    app::StageMoment random_moment(std::mt19937& random, double highest_m) {
        const io::TerrainInfo& info = store_->info();
        app::StageMoment moment;
        moment.camera.lens.size_px = kSize;
        moment.background = kMagenta;
        const glm::dvec2 place = info.world(uniform(random, 0.1, 0.9) * static_cast<double>(info.width - 1),
                                            uniform(random, 0.1, 0.9) * static_cast<double>(info.height - 1));
        const double above_m = std::exp(uniform(random, std::log(4.0), std::log(highest_m)));
        moment.camera.pose = {glm::dvec3(place, info.max_height_m + above_m),
                              Angle::from_degrees(uniform(random, -180.0, 180.0)),
                              Angle::from_degrees(uniform(random, -70.0, -8.0))};
        return moment;
    }

    // Down in the valleys, where ridges hide much.
    app::StageMoment moment_near_ground(std::mt19937& random) {
        app::StageMoment moment = random_moment(random, 5.0);
        moment.camera.pose.pitch = Angle::from_degrees(uniform(random, -12.0, 4.0));
        moment.camera.pose.eye_m.z = store_->info().min_height_m - 10.0;
        take(moment, render::Surface::mesh);
        moment.camera.pose.eye_m.z += report_.eye_lift_m + std::exp(uniform(random, 0.5, 4.0));
        return moment;
    }

    const io::Store& store() const { return *store_; }
    app::TerrainStage& stage() { return *stage_; }
    const app::StageReport& report() const { return report_; }

  private:
    ScratchFolder folder_;
    std::unique_ptr<io::Store> store_;
    jobs::JobSystem jobs_{{.workers = 1}};
    std::unique_ptr<app::TerrainStage> stage_;
    app::StageReport report_;
};

struct Difference {
    double mean = 0.0;         // of 255, over what is ground in both
    double ground = 0.0;       // share of the picture that is ground in the first
    double other_shape = 0.0;  // share of the ground that is ground in one of them only
};

bool is_ground(const gl::Image& image, std::size_t pixel) {
    return image.rgb[3 * pixel] != std::byte{255} || image.rgb[3 * pixel + 1] != std::byte{0} ||
           image.rgb[3 * pixel + 2] != std::byte{255};
}

Difference difference(const gl::Image& a, const gl::Image& b) {
    std::size_t both = 0, one = 0, first = 0;
    double sum = 0.0;
    const std::size_t pixels = a.rgb.size() / 3;
    for (std::size_t i = 0; i < pixels; ++i) {
        first += is_ground(a, i) ? 1 : 0;
        if (is_ground(a, i) != is_ground(b, i)) ++one;
        if (!is_ground(a, i) || !is_ground(b, i)) continue;
        ++both;
        for (std::size_t c = 3 * i; c < 3 * i + 3; ++c)
            sum += std::abs(std::to_integer<int>(a.rgb[c]) - std::to_integer<int>(b.rgb[c]));
    }
    Difference found;
    if (both > 0) found.mean = sum / (3.0 * static_cast<double>(both));
    found.ground = static_cast<double>(first) / static_cast<double>(pixels);
    found.other_shape = static_cast<double>(one) / static_cast<double>(std::max<std::size_t>(first, 1));
    return found;
}

}  // namespace

namespace {

// sampled: the disc or the quadtree.
void shows_the_same_land(render::Surface sampled) {
    // Measured of the disc: at most 1.6 and, where there are holes, 0.018.
    constexpr double kMostMean = 2.5, kMostOtherShape = 0.025;
    constexpr int kViews = 12;
    constexpr double kHighest_m = 3000.0;  // over the land's highest place
    std::mt19937 random(20261127);
    int wide = 0, told = 0;
    for (const Land& land : kLands) {
        CAPTURE(std::string(land.name));
        Gallery gallery(land);
        double ground = 0.0;
        for (int i = 0; i < kViews; ++i) {
            const app::StageMoment moment = gallery.random_moment(random, kHighest_m);
            const gl::Image mesh = gallery.take(moment, render::Surface::mesh);
            const gl::Image other = gallery.take(moment, sampled);
            CHECK(gallery.report().heights_missing == 0);
            const Difference found = difference(mesh, other);
            ground += found.ground / kViews;
            if (found.ground < 0.1) continue;
            CHECK(found.mean < kMostMean);
            CHECK(found.other_shape < kMostOtherShape);
            // Land that is not quite the same would be told.
            app::StageMoment aside = moment;
            aside.camera.pose.heading = moment.camera.pose.heading + Angle::from_degrees(6.0);
            const Difference wrong = difference(mesh, gallery.take(aside, sampled));
            ++wide;
            told += wrong.mean >= kMostMean || wrong.other_shape >= kMostOtherShape ? 1 : 0;
        }
        CHECK(ground > 0.01);
    }
    CHECK(wide > 40);
    CHECK(told > wide * 9 / 10);
}

}  // namespace

TEST_CASE("The disc shows the land that the mesh shows, whatever its shape") {
    GlContext gl;
    if (!gl) return;
    shows_the_same_land(render::Surface::disc);
}

TEST_CASE("So does the quadtree") {
    GlContext gl;
    if (!gl) return;
    shows_the_same_land(render::Surface::quadtree);
}

TEST_CASE("Imagery lies on disc and quadtree as it lies on the mesh") {
    GlContext gl;
    if (!gl) return;
    // Fields of eight samples' width, so that a shift of one would tell.
    const auto fields = [](std::int64_t x, std::int64_t y) {
        const bool dark = ((x >> 5) ^ (y >> 5)) & 1;
        const auto shade = static_cast<std::uint8_t>(dark ? 60 : 190);
        return build::Texel{shade, static_cast<std::uint8_t>(x * 7 % 200), shade, build::kOpaque};
    };
    std::mt19937 random(11);
    Gallery gallery(kLands[1], {}, [&](const std::filesystem::path& directory) {
        const auto info = io::read_terrain_info(directory);
        REQUIRE(info);
        MemoryTexels texels(frame_over(*info, 4), fields);
        add_imagery(directory, texels);
    });
    for (int i = 0; i < 12; ++i) {
        const app::StageMoment moment = gallery.random_moment(random, 500.0);
        const gl::Image mesh = gallery.take(moment, render::Surface::mesh);
        CHECK(gallery.report().imagery_missing == 0);
        for (const render::Surface sampled : {render::Surface::disc, render::Surface::quadtree}) {
            const gl::Image other = gallery.take(moment, sampled);
            CHECK(gallery.report().imagery_missing == 0);
            const Difference found = difference(mesh, other);
            if (found.ground < 0.1) continue;
            // Measured: at most 3.6 of the disc; of the quadtree, whose cells may be a pixel beside, 8.2.
            CHECK(found.mean < (sampled == render::Surface::disc ? 5.0 : 10.0));
            CHECK(found.other_shape < 0.025);
            app::StageMoment tinted = moment;
            tinted.cover = render::Cover::tint;
            CHECK(difference(other, gallery.take(tinted, sampled)).mean > 20.0);
        }
    }
}

TEST_CASE("The GPU's cache keeps its bytes with chunks, heights and imagery in it") {
    GlContext gl;
    if (!gl) return;
    std::mt19937 random(12);
    app::StageOptions options;
    options.frame.gpu_cache_bytes = 1_MiB;
    Gallery gallery({"wide", 900, 700, hills}, options, [&](const std::filesystem::path& directory) {
        const auto info = io::read_terrain_info(directory);
        REQUIRE(info);
        MemoryTexels texels(frame_over(*info, 2), [](std::int64_t x, std::int64_t) {
            return build::Texel{static_cast<std::uint8_t>(x), 90, 60, build::kOpaque};
        });
        add_imagery(directory, texels);
    });
    app::TerrainStage& stage = gallery.stage();
    CHECK(stage.gpu_cache_capacity_bytes() <= 1_MiB);
    CHECK(stage.gpu_heights_capacity_bytes() <= 256_KiB);
    bool full = false;
    for (int i = 0; i < 30; ++i) {
        app::StageMoment moment = gallery.random_moment(random, 300.0);
        gallery.take(moment, i % 3 == 0 ? render::Surface::mesh : render::Surface::disc);
        REQUIRE(stage.gpu_heights_bytes() <= stage.gpu_heights_capacity_bytes());
        REQUIRE(stage.gpu_cache_bytes() <= stage.gpu_cache_capacity_bytes());
        full = full || stage.gpu_heights_bytes() == stage.gpu_heights_capacity_bytes();
    }
    CHECK(full);
}

namespace {

void horizon_changes_nothing(render::Surface sampled, int detail_octaves = 0) {
    std::mt19937 random(7);
    Gallery gallery({"valleys", 900, 700, hills});
    constexpr std::size_t kViews = 40;
    std::vector<app::StageMoment> moments;
    for (std::size_t i = 0; i < kViews; ++i) moments.push_back(gallery.moment_near_ground(random));
    std::vector<gl::Image> all;
    app::StageOptions options;
    options.frame.detail_octaves = detail_octaves;
    options.horizon = select::HorizonMode::off;
    gallery.open(options);
    for (const app::StageMoment& moment : moments) all.push_back(gallery.take(moment, sampled));
    options.horizon = select::HorizonMode::ridges;
    gallery.open(options);
    int different = 0;
    std::uint64_t hidden = 0;
    for (std::size_t i = 0; i < kViews; ++i) {
        different += gallery.take(moments[i], sampled).rgb == all[i].rgb ? 0 : 1;
        hidden += gallery.report().selection.horizon_culled;
    }
    CHECK(different == 0);
    CHECK(hidden > 100);
}

}  // namespace

TEST_CASE("Culling by the horizon changes no pixel of the disc") {
    GlContext gl;
    if (!gl) return;
    horizon_changes_nothing(render::Surface::disc);
}

// Which tiles are there decides its cells: a tile that is hidden is none, and ground beside it is drawn by
// other triangles.
TEST_CASE("Culling by the horizon changes no pixel of the quadtree") {
    GlContext gl;
    if (!gl) return;
    horizon_changes_nothing(render::Surface::quadtree);
}

// What chunks know of their ground holds for what is drawn in their place only with allowance.
TEST_CASE("Culling by the horizon changes no pixel of the mesh where it gives way to made ground") {
    GlContext gl;
    if (!gl) return;
    horizon_changes_nothing(render::Surface::mesh, 2);
}

TEST_CASE("Heights are wanted as much finer as the quadtree's errors are stretched") {
    GlContext gl;
    if (!gl) return;
    SceneOptions options;
    options.width = options.height = 1025;
    options.stage.frame.size_px = {160, 120};
    options.stage.frame.surfaces = render::Surfaces::all;
    options.stage.wait = app::TileWait::settle;
    RenderScene scene(options);
    const auto wanted = [&](render::Surface surface, double exaggeration) {
        app::StageMoment moment;
        moment.surface = surface;
        moment.exaggeration = exaggeration;
        moment.camera.lens.size_px = options.stage.frame.size_px;
        moment.camera.pose = {scene.place(512, 512, 900.0), Angle(), Angle::from_degrees(-60.0)};
        return scene.stage().show(moment).heights_wanted;
    };
    CHECK(wanted(render::Surface::quadtree, 4.0) > 2 * wanted(render::Surface::quadtree, 1.0));
    // As for the mesh, flattening makes nothing coarser than light wants it.
    CHECK(wanted(render::Surface::quadtree, 0.5) >= wanted(render::Surface::quadtree, 1.0));
    CHECK(wanted(render::Surface::disc, 4.0) < 2 * wanted(render::Surface::disc, 1.0));
}
