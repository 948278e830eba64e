// A stage whose selection passes through other hands before it is drawn: what tests break on purpose, to see
// that they would notice.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "gl/render_scene.h"
#include "ridgeline/render/frame.h"
#include "ridgeline/render/shadow_cascades.h"
#include "ridgeline/select/selection.h"

namespace ridgeline::test {

// What of a selection can be tampered with.
struct Tampered {
    std::vector<select::DrawEntry> draws;
    std::vector<select::ShadowCaster> casters;
};
using Sabotage = std::function<void(Tampered&)>;

struct TamperedOptions {
    glm::ivec2 size_px{400, 300};
    double pixel_error = 1.0;
    select::CasterSet shadows = select::CasterSet::none;
    int shadow_map_px = 512;
};

class TamperedStage {
  public:
    TamperedStage(const io::Store& store, jobs::JobSystem& jobs, const TamperedOptions& options)
        : store_(store),
          options_(options),
          criterion_(std::move(select::make_criterion("screen_error")).value()),
          pager_(
              std::move(pager::Pager::create(pager::tile_source(store), jobs, {.fade = pager::Seconds(0.0)}))
                  .value()),
          selection_(store.info(), store.records(), *criterion_),
          frame_(std::move(render::Frame::create(
                               store, {.size_px = options.size_px, .shadow_map_px = options.shadow_map_px}))
                     .value()) {
        REQUIRE(pager_.load_level0());
        if (options.shadows != select::CasterSet::none) REQUIRE(frame_.allow_shadows());
    }

    // Camera, daylight and background of the moment; once all tiles are there.
    gl::Image show(const app::StageMoment& moment, const Sabotage& sabotage) {
        do {
            step(moment);
        } while (!pager_.settled());
        const select::SelectionResult& selected = selection_.result();
        Tampered tampered{{selected.draws.begin(), selected.draws.end()},
                          {selected.casters.begin(), selected.casters.end()}};
        sabotage(tampered);
        select::SelectionResult drawn = selected;
        drawn.draws = tampered.draws;
        drawn.casters = tampered.casters;
        render::FrameScene scene;
        scene.view = {moment.camera, drawn.eye, moment.exaggeration, moment.daylight, moment.background};
        scene.selection = &drawn;
        scene.pager = &pager_;
        scene.shadows = options_.shadows == select::CasterSet::none ? nullptr : &cascades_;
        frame_.draw(scene);
        frame_.end_frame();
        return gl::read_image(frame_.target());
    }

  private:
    void step(const app::StageMoment& moment) {
        ++step_;
        frame_.begin_frame(step_);
        pager_.begin_frame(step_, pager::Seconds(step_));
        frame_.upload_all(pager_);
        {
            const auto lease = pager_.lend_to_selection();
            selection_.run(view_of(moment), lease.snapshot());
        }
        pager_.touch(selection_.result().used);
        std::vector<pager::NodeIndex> wanted;
        for (const auto& tile : selection_.result().wanted) wanted.push_back(tile.index);
        pager_.request(wanted);
    }

    select::View view_of(const app::StageMoment& moment) {
        const platform::Camera& camera = moment.camera;
        select::Camera eye;
        eye.eye_m = camera.pose.eye_m;
        eye.right = platform::right(camera.pose);
        eye.up = platform::up(camera.pose);
        eye.forward = platform::forward(camera.pose);
        eye.horizontal_field = camera.lens.horizontal_fov;
        eye.width_px = camera.lens.size_px.x;
        eye.height_px = camera.lens.size_px.y;
        select::View view = select::make_view(
            eye, {.pixel_error_px = options_.pixel_error, .exaggeration = moment.exaggeration});
        cascades_ = render::shadow_cascades(
            {.camera = camera,
             .daylight = moment.daylight,
             .terrain_m = select::drawn_bounds(store_.info(), store_.records(), moment.exaggeration),
             .spacing_m = store_.info().spacing_x_m,
             .map_px = options_.shadow_map_px});
        view.sun = render::sun_view(cascades_, options_.shadows);
        return view;
    }

    const io::Store& store_;
    TamperedOptions options_;
    std::unique_ptr<select::Criterion> criterion_;
    pager::Pager pager_;
    select::Selection selection_;
    render::Frame frame_;
    render::ShadowCascades cascades_;
    std::uint32_t step_ = 0;
};

}  // namespace ridgeline::test
