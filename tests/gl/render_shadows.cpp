// Shadows: the casters of what is seen make the picture that all casters make; leaving one out shows; what
// lies in the light stays as it was.
#include <cmath>
#include <cstdlib>
#include <optional>
#include <random>

#include "gl/tampered_stage.h"
#include "ridgeline/build/builder.h"
#include "unit/raster_fixture.h"

using namespace ridgeline;
using namespace ridgeline::test;

namespace {

constexpr glm::ivec2 kSize_px(240, 180);
constexpr int kMap_px = 512;
// On so small a terrain, several levels within a picture.
constexpr double kPixelError = 0.6;
constexpr double kSpacing_m = 20.0;
constexpr double kWest_m = 300000.0, kNorth_m = 5200000.0;
constexpr double kNodata = -32768.0;

using Height = double (*)(double column, double row);

// A store built from a raster that does not fill its nodes, with a lake of missing data where asked for.
class BuiltStore {
  public:
    BuiltStore(int width, int height, Height height_m, bool (*is_missing)(double column, double row)) {
        raster::Spec spec{.width = width, .height = height};
        spec.transform = {kWest_m - 0.5 * kSpacing_m,  kSpacing_m, 0,
                          kNorth_m + 0.5 * kSpacing_m, 0,          -kSpacing_m};
        spec.nodata = kNodata;
        for (int row = 0; row < height; ++row)
            for (int column = 0; column < width; ++column)
                spec.values.push_back(is_missing(column, row) ? kNodata : std::round(height_m(column, row)));
        build::BuildOptions options;
        options.sources = {raster::write_raster(folder_.file("dem.tif"), spec)};
        options.out = folder_.file("dem.terrain");
        options.tile = 33;
        const auto built = build::build_terrain(options);
        REQUIRE_MESSAGE(built.ok(), (built.ok() ? "" : built.error().message));
        auto store = io::Store::open(options.out);
        REQUIRE(store.ok());
        store_ = std::make_unique<io::Store>(std::move(store).value());
    }
    const io::Store& store() const { return *store_; }

  private:
    raster::TempFolder folder_;
    std::unique_ptr<io::Store> store_;
};

// Chains of peaks, steep on all sides, with valleys between them.
double mountains_m(double column, double row) {
    const double chains = 1.0 - std::abs(std::sin(column * 0.041 + 0.8 * std::sin(row * 0.026)));
    const double spurs = 1.0 - std::abs(std::sin(row * 0.087 + column * 0.019));
    const double rough = std::sin(column * 0.31) * std::sin(row * 0.27);
    return 1100.0 * chains * chains + 420.0 * spurs + 25.0 * rough;
}
bool lakes(double column, double row) {
    return std::hypot(column - 120.0, row - 190.0) < 17.0 || std::hypot(column - 290.0, row - 60.0) < 9.0;
}

// Nowhere steeper than nine degrees, rounded to metres as it is.
double dome_m(double column, double row) { return 120.0 * std::cos(column * 0.013) * std::cos(row * 0.011); }
bool nowhere(double, double) { return false; }

double uniform(std::mt19937& random, double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random);
}

int views_to_try() { return std::getenv("RIDGELINE_LONG") ? 1000 : 60; }

// Anywhere over or beside the terrain, from 2 m above the ground, under any sun.
app::StageMoment random_moment(std::mt19937& random, const io::TerrainInfo& info, Height ground_m,
                               double highest_m = 6000.0) {
    app::StageMoment moment;
    moment.exaggeration = random() % 4 == 0 ? uniform(random, 0.5, 3.0) : 1.0;
    const double column = uniform(random, -0.1, 1.1) * static_cast<double>(info.width);
    const double row = uniform(random, -0.1, 1.1) * static_cast<double>(info.height);
    const double above_m = std::exp(uniform(random, std::log(2.0), std::log(highest_m)));
    moment.camera.lens.size_px = kSize_px;
    moment.camera.lens.horizontal_fov = Angle::from_degrees(uniform(random, 30.0, 100.0));
    moment.camera.pose = {{info.world(column, row), moment.exaggeration * ground_m(column, row) + above_m},
                          Angle::from_degrees(uniform(random, -180.0, 180.0)),
                          Angle::from_degrees(uniform(random, above_m > 500.0 ? -90.0 : -30.0, 10.0))};
    const double elevations[] = {0.4, 3.0, uniform(random, 3.0, 15.0), uniform(random, 15.0, 60.0), 90.0};
    moment.daylight = {Angle::from_degrees(uniform(random, 0.0, 360.0)),
                       Angle::from_degrees(elevations[random() % 5])};
    return moment;
}

int brightness(const gl::Image& image, std::size_t pixel) {
    int sum = 0;
    for (std::size_t i = 0; i < 3; ++i) sum += std::to_integer<int>(image.rgb[3 * pixel + i]);
    return sum;
}

struct Difference {
    int brighter = 0, darker = 0;
};
// Pixels of `other` against those of `image`, by more than dithering.
Difference compare(const gl::Image& image, const gl::Image& other) {
    constexpr int kDither = 3;
    Difference difference;
    for (std::size_t pixel = 0; pixel < image.rgb.size() / 3; ++pixel) {
        const int step = brightness(other, pixel) - brightness(image, pixel);
        difference.brighter += step > kDither ? 1 : 0;
        difference.darker += step < -kDither ? 1 : 0;
    }
    return difference;
}

std::unique_ptr<app::TerrainStage> open_stage(const io::Store& store, jobs::JobSystem& jobs) {
    app::StageOptions options;
    options.frame.size_px = kSize_px;
    options.frame.shadow_map_px = kMap_px;
    options.pixel_error = kPixelError;
    options.wait = app::TileWait::settle;
    options.shadows = select::CasterSet::pvs;
    auto stage = app::TerrainStage::create(store, jobs, options);
    REQUIRE_MESSAGE(stage.ok(), (stage.ok() ? "" : stage.error().message));
    return std::move(stage).value();
}

class ShadowScene {
  public:
    gl::Image show(const app::StageMoment& moment, select::CasterSet shadows) {
        REQUIRE(stage_->set_shadows(shadows));
        report_ = stage_->show(moment);
        return gl::read_image(stage_->target());
    }
    std::uint32_t casters() const { return report_.selection.casters; }
    const io::Store& store() const { return store_.store(); }
    jobs::JobSystem& jobs() { return jobs_; }

    explicit ShadowScene(Height height_m, bool (*is_missing)(double, double) = nowhere)
        : store_(411, 330, height_m, is_missing), stage_(open_stage(store_.store(), jobs_)) {}

  private:
    BuiltStore store_;
    jobs::JobSystem jobs_{{.workers = 1}};
    std::unique_ptr<app::TerrainStage> stage_;
    app::StageReport report_;
};

void drop_casters_out_of_view(Tampered& tampered) {
    std::erase_if(tampered.casters, [&](const select::ShadowCaster& caster) {
        return std::ranges::none_of(tampered.draws, [&](const select::DrawEntry& entry) {
            return entry.index == caster.entry.index;
        });
    });
}

}  // namespace

TEST_CASE("The casters of what is seen make the same picture as all, pixel by pixel") {
    GlContext gl;
    if (!gl) return;
    ShadowScene scene(mountains_m, lakes);
    std::mt19937 random(20260621);
    std::uint64_t some = 0, all = 0;
    int shaded = 0;
    for (int i = 0; i < views_to_try(); ++i) {
        CAPTURE(i);
        const auto moment = random_moment(random, scene.store().info(), mountains_m);
        const gl::Image with_all = scene.show(moment, select::CasterSet::all);
        all += scene.casters();
        const gl::Image with_some = scene.show(moment, select::CasterSet::pvs);
        some += scene.casters();
        CHECK(with_some.rgb == with_all.rgb);
        const Difference difference = compare(scene.show(moment, select::CasterSet::none), with_some);
        CHECK(difference.brighter == 0);
        shaded += difference.darker;
    }
    // The test would prove little if there were no shadows, or no casters left out.
    CHECK(shaded > views_to_try() * 1000);
    CHECK(some < all * 9 / 10);
    MESSAGE(all, " casters, ", some, " of them for what is seen; ", shaded, " pixels shaded");
}

TEST_CASE("Casters that are not in view darken what is, and leaving them out shows") {
    GlContext gl;
    if (!gl) return;
    ShadowScene scene(mountains_m, lakes);
    TamperedStage stage(scene.store(), scene.jobs(),
                        {.size_px = kSize_px,
                         .pixel_error = kPixelError,
                         .shadows = select::CasterSet::pvs,
                         .shadow_map_px = kMap_px});
    std::mt19937 random(3);
    int changed = 0;
    Difference sum;
    for (int i = 0; i < 30; ++i) {
        auto moment = random_moment(random, scene.store().info(), mountains_m, 100.0);
        moment.daylight.sun_elevation = Angle::from_degrees(uniform(random, 4.0, 25.0));
        const gl::Image whole = stage.show(moment, [](Tampered&) {});
        const gl::Image broken = stage.show(moment, drop_casters_out_of_view);
        const Difference difference = compare(whole, broken);
        sum.brighter += difference.brighter;
        sum.darker += difference.darker;
        changed += whole.rgb != broken.rgb ? 1 : 0;
    }
    CHECK(changed >= 3);
    CHECK(sum.brighter > 1000);
    CHECK(sum.darker == 0);
}

TEST_CASE("Ground that nothing shades is lit as without shadows") {
    GlContext gl;
    if (!gl) return;
    ShadowScene scene(dome_m);
    std::mt19937 random(5);
    int compared = 0;
    for (int i = 0; i < views_to_try() / 2; ++i) {
        auto moment = random_moment(random, scene.store().info(), dome_m);
        moment.exaggeration = 1.0;
        moment.daylight.sun_elevation = Angle::from_degrees(uniform(random, 14.0, 90.0));
        CAPTURE(i);
        const gl::Image plain = scene.show(moment, select::CasterSet::none);
        CHECK(scene.show(moment, select::CasterSet::pvs).rgb == plain.rgb);
        compared += static_cast<int>(plain.rgb.size());
    }
    CHECK(compared > 0);
}

TEST_CASE("Without a sun there are no shadows") {
    GlContext gl;
    if (!gl) return;
    ShadowScene scene(mountains_m, lakes);
    std::mt19937 random(9);
    for (int i = 0; i < 5; ++i) {
        auto moment = random_moment(random, scene.store().info(), mountains_m);
        moment.daylight.sun_elevation = Angle::from_degrees(-0.5 * i);
        const gl::Image plain = scene.show(moment, select::CasterSet::none);
        CHECK(scene.show(moment, select::CasterSet::pvs).rgb == plain.rgb);
        CHECK(scene.casters() == 0);
    }
}
