// The crack test can fail: each rule that keeps the surface whole, broken on purpose, shows as wrong
// background.
#include <random>

#include "gl/tampered_stage.h"
#include "ridgeline/app/bench/background_pixels.h"
#include "support/ray_under_ground.h"

using namespace ridgeline;
using namespace ridgeline::test;

namespace {

constexpr glm::ivec2 kSize_px(400, 300);
// Coarse enough that levels change within the picture.
constexpr double kPixelError = 12.0;

// A look down, at ground on all sides, finds no sky: each wrong pixel is a crack, and its rays must say so.
bool is_crack(const RenderScene& scene, const platform::Camera& camera, const glm::ivec2& pixel) {
    constexpr double kStep_m = 1.0, kReach_m = 1000.0;
    return looks_at_ground(camera, pixel, kStep_m, kReach_m, [&](const glm::dvec2& place_m) {
        const glm::dvec2 place = scene.info().lattice(place_m.x, place_m.y);
        return std::optional(scene.surface_m(place.x, place.y));
    });
}

// Wrong pixels over a number of looks down at the terrain from random places.
int wrong_pixels(TamperedStage& stage, const RenderScene& scene, const Sabotage& sabotage) {
    constexpr int kLooks = 24;
    std::mt19937 random(3);
    int wrong = 0;
    for (int i = 0; i < kLooks; ++i) {
        platform::Camera camera;
        camera.lens.size_px = kSize_px;
        const double column = 60.0 + static_cast<double>(random() % 140),
                     row = 60.0 + static_cast<double>(random() % 140);
        const double above_m = 60.0 + static_cast<double>(random() % 140);
        camera.pose = {scene.place(column, row, scene.surface_m(column, row) + above_m),
                       Angle::from_degrees(static_cast<double>(random() % 360)), Angle::from_degrees(-65.0)};
        app::StageMoment moment;
        moment.camera = camera;
        moment.background = render::PlainBackground{255, 0, 255};
        const gl::Image image = stage.show(moment, sabotage);
        for (const glm::ivec2& pixel : app::BackgroundPixels(image, {255, 0, 255}).wrong(camera)) {
            CHECK(is_crack(scene, camera, pixel));
            ++wrong;
        }
    }
    return wrong;
}

void drop_fans(Tampered& tampered) {
    for (auto& entry : tampered.draws)
        for (auto& quarter : entry.sides)
            for (auto& side : quarter)
                if (side == select::SideUse::fan) side = select::SideUse::plain;
}

void never_morph(Tampered& tampered) {
    for (auto& entry : tampered.draws) entry.morph = {};
}

void lose_a_node(Tampered& tampered) {
    auto& draws = tampered.draws;
    draws.erase(draws.begin() + static_cast<std::ptrdiff_t>(draws.size() / 3));
}

}  // namespace

TEST_CASE("Every broken rule of the watertight surface shows as wrong background") {
    GlContext gl;
    if (!gl) return;
    RenderScene scene({});
    jobs::JobSystem jobs{{.workers = 1}};
    TamperedStage stage(scene.store(), jobs, {.size_px = kSize_px, .pixel_error = kPixelError});
    CHECK(wrong_pixels(stage, scene, [](Tampered&) {}) == 0);
    CHECK(wrong_pixels(stage, scene, drop_fans) > 0);
    CHECK(wrong_pixels(stage, scene, never_morph) > 0);
    CHECK(wrong_pixels(stage, scene, lose_a_node) > 0);
}
