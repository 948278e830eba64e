// The frame as a picture: orientation, size, sky and background.
#include "gl/render_scene.h"

using namespace ridgeline;
using namespace ridgeline::test;

TEST_CASE("A first picture") {
    GlContext gl;
    if (!gl) return;
    SceneOptions options;
    options.stage.frame.size_px = {640, 480};
    options.stage.wait = app::TileWait::settle;
    RenderScene scene(options);
    app::StageMoment moment;
    moment.camera.lens.size_px = {640, 480};
    moment.camera.pose = {scene.place(128, 250, 80.0), Angle::from_degrees(0.0), Angle::from_degrees(-15.0)};
    const auto report = scene.stage().show(moment);
    CHECK(report.surface.triangles > 0);
    const auto image = gl::read_image(scene.stage().target());
    CHECK(gl::write_png("/tmp/h7b_first.png", image).ok());
}
