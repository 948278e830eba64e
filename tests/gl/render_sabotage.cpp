// The crack test can fail: each rule that keeps the surface whole, broken on purpose, shows as wrong
// background.
#include <functional>
#include <random>
#include <vector>

#include "gl/render_scene.h"
#include "ridgeline/render/frame.h"
#include "ridgeline/select/selection.h"
#include "support/background_pixels.h"

using namespace ridgeline;
using namespace ridgeline::test;

namespace {

using Draws = std::vector<select::DrawEntry>;
using Sabotage = std::function<void(Draws&)>;

constexpr glm::ivec2 kSize_px(400, 300);
// Coarse enough that levels change within the picture.
constexpr double kPixelError = 12.0;

// A stage whose draw list passes through other hands before it is drawn.
class TamperedStage {
  public:
    TamperedStage(const io::Store& store, jobs::JobSystem& jobs)
        : info_(store.info()),
          criterion_(std::move(select::make_criterion("screen_error")).value()),
          pager_(
              std::move(pager::Pager::create(pager::tile_source(store), jobs, {.fade = pager::Seconds(0.0)}))
                  .value()),
          selection_(store.info(), store.records(), *criterion_),
          frame_(std::move(render::Frame::create(store, {.size_px = kSize_px})).value()) {
        REQUIRE(pager_.load_level0());
    }

    gl::Image show(const platform::Camera& camera, const Sabotage& sabotage) {
        do {
            step(camera);
        } while (!pager_.settled());
        Draws draws(selection_.result().draws.begin(), selection_.result().draws.end());
        sabotage(draws);
        select::SelectionResult tampered = selection_.result();
        tampered.draws = draws;
        render::FrameScene scene;
        scene.view.camera = camera;
        scene.view.eye = tampered.eye;
        scene.view.background = render::PlainBackground{255, 0, 255};
        scene.selection = &tampered;
        scene.pager = &pager_;
        frame_.draw(scene);
        frame_.end_frame();
        return gl::read_image(frame_.target());
    }

  private:
    void step(const platform::Camera& camera) {
        ++step_;
        frame_.begin_frame(step_);
        pager_.begin_frame(step_, pager::Seconds(step_));
        frame_.upload_all(pager_);
        select::Camera eye;
        eye.eye_m = camera.pose.eye_m;
        eye.right = platform::right(camera.pose);
        eye.up = platform::up(camera.pose);
        eye.forward = platform::forward(camera.pose);
        eye.horizontal_field = camera.lens.horizontal_fov;
        eye.width_px = camera.lens.size_px.x;
        eye.height_px = camera.lens.size_px.y;
        {
            const auto lease = pager_.lend_to_selection();
            selection_.run(select::make_view(eye, {.pixel_error_px = kPixelError}), lease.snapshot());
        }
        pager_.touch(selection_.result().used);
        std::vector<pager::NodeIndex> wanted;
        for (const auto& tile : selection_.result().wanted) wanted.push_back(tile.index);
        pager_.request(wanted);
    }

    const io::TerrainInfo& info_;
    std::unique_ptr<select::Criterion> criterion_;
    pager::Pager pager_;
    select::Selection selection_;
    render::Frame frame_;
    std::uint32_t step_ = 0;
};

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
        wrong += BackgroundPixels(stage.show(camera, sabotage), {255, 0, 255}).count_wrong(camera);
    }
    return wrong;
}

void drop_fans(Draws& draws) {
    for (auto& entry : draws)
        for (auto& quarter : entry.sides)
            for (auto& side : quarter)
                if (side == select::SideUse::fan) side = select::SideUse::plain;
}

void never_morph(Draws& draws) {
    for (auto& entry : draws) entry.morph = {};
}

void lose_a_node(Draws& draws) { draws.erase(draws.begin() + static_cast<std::ptrdiff_t>(draws.size() / 3)); }

}  // namespace

TEST_CASE("Every broken rule of the watertight surface shows as wrong background") {
    GlContext gl;
    if (!gl) return;
    RenderScene scene({});
    jobs::JobSystem jobs{{.workers = 1}};
    TamperedStage stage(scene.store(), jobs);
    CHECK(wrong_pixels(stage, scene, [](Draws&) {}) == 0);
    CHECK(wrong_pixels(stage, scene, drop_fans) > 0);
    CHECK(wrong_pixels(stage, scene, never_morph) > 0);
    CHECK(wrong_pixels(stage, scene, lose_a_node) > 0);
}
