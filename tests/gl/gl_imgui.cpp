#include <doctest/doctest.h>
#include <imgui.h>

#include <cstdlib>

#include "imgui_layer.h"
#include "ridgeline/gl/screenshot.h"
#include "support/gl_context.h"

namespace ridgeline::app {
namespace {

gl::Image hud_over_blue(ImguiLayer& layer, const gl::RenderTarget& target) {
    target.framebuffer.bind();
    glClearColor(0.0f, 0.2f, 0.6f, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    layer.begin_frame(target.framebuffer.size_px(), std::chrono::duration<double>(1.0 / 60.0));
    ImGui::SetNextWindowPos({10, 10});
    ImGui::SetNextWindowSize({200, 100});
    ImGui::Begin("Ridgeline");
    ImGui::Text("triangles 131072");
    ImGui::ProgressBar(0.4f);
    ImGui::End();
    layer.draw(target.framebuffer);
    return gl::read_image(target.framebuffer);
}

TEST_CASE("without a window the HUD draws over the frame, the same pixels every time") {
    test::GlContext context;
    if (!context) return;
    const auto layer = ImguiLayer::create(context.context());
    REQUIRE(layer);
    const auto target = gl::RenderTarget::create({.size_px = {320, 200}});
    REQUIRE(target);
    // ImGui sizes and fades in over its first frames.
    for (int i = 0; i < 3; ++i) hud_over_blue(**layer, *target);
    const gl::Image image = hud_over_blue(**layer, *target);
    CHECK(image.rgb == hud_over_blue(**layer, *target).rgb);
    if (const char* folder = std::getenv("RIDGELINE_TEST_OUT"))
        CHECK(gl::write_png(std::filesystem::path(folder) / "hud.png", image));
    std::size_t changed = 0;
    for (std::size_t i = 0; i < image.rgb.size(); i += 3)
        changed += image.rgb[i + 2] == std::byte{153} ? 0 : 1;
    CHECK(changed > 190 * 90);
    CHECK(changed < 210 * 110);
    CHECK_FALSE((*layer)->wants_keyboard());
}

TEST_CASE("the HUD leaves the program's GL conventions as they were") {
    test::GlContext context;
    if (!context) return;
    const auto layer = ImguiLayer::create(context.context());
    const auto target = gl::RenderTarget::create({.size_px = {320, 200}});
    REQUIRE((layer && target));
    hud_over_blue(**layer, *target);
    CHECK(glIsEnabled(GL_DEPTH_TEST) == GL_TRUE);
    CHECK(glIsEnabled(GL_CULL_FACE) == GL_TRUE);
    CHECK(glIsEnabled(GL_BLEND) == GL_FALSE);
    CHECK(glIsEnabled(GL_SCISSOR_TEST) == GL_FALSE);
    GLint value = 0;
    glGetIntegerv(GL_DEPTH_FUNC, &value);
    CHECK(value == GL_GREATER);
    glGetIntegerv(GL_CLIP_DEPTH_MODE, &value);
    CHECK(value == GL_ZERO_TO_ONE);
}

}  // namespace
}  // namespace ridgeline::app
