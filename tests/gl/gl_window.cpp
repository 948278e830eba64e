#include <doctest/doctest.h>
#include <imgui.h>

#include <array>
#include <cstdlib>

#include "imgui_layer.h"
#include "ridgeline/gl/capabilities.h"
#include "ridgeline/gl/debug_output.h"
#include "ridgeline/gl/screenshot.h"
#include "ridgeline/platform/context.h"

namespace ridgeline {
namespace {

TEST_CASE("without a display a window is refused in a line that names the mend") {
    if (std::getenv("DISPLAY") != nullptr || std::getenv("WAYLAND_DISPLAY") != nullptr) return;
    const auto context = platform::open_window({});
    REQUIRE_FALSE(context);
    MESSAGE(context.error().message);
    CHECK(context.error().message.starts_with("no display: "));
    CHECK(context.error().message.ends_with("use --headless"));
}

// The window's own pixels, bottom row first.
std::vector<std::uint8_t> window_pixels(const glm::ivec2& size_px) {
    std::vector<std::uint8_t> pixels(static_cast<std::size_t>(size_px.x * size_px.y * 3));
    glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
    glReadBuffer(GL_BACK);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadnPixels(0, 0, size_px.x, size_px.y, GL_RGB, GL_UNSIGNED_BYTE, static_cast<GLsizei>(pixels.size()),
                  pixels.data());
    return pixels;
}

TEST_CASE("a window opens, shows a frame with its HUD, and reports no GL error") {
    if (std::getenv("DISPLAY") == nullptr) {
        MESSAGE("skipped: no display");
        return;
    }
    auto opened = platform::open_window({.title = "test",
                                         .size_px = {320, 200},
                                         .vertical_sync = platform::VerticalSync::off,
                                         .debug = platform::ContextDebug::on});
    REQUIRE_MESSAGE(opened.ok(), (opened ? "" : opened.error().message));
    platform::Context& context = **opened;
    REQUIRE(gl::load(context.gl_loader()));
    gl::enable_debug_output();
    gl::set_frame_conventions();
    MESSAGE(context.description(), ": ", gl::query_capabilities().renderer);
    const auto errors_before = gl::debug_error_count();
    {
        const auto target = gl::RenderTarget::create({.size_px = context.size_px()});
        REQUIRE(target);
        const auto layer = app::ImguiLayer::create(context);
        REQUIRE(layer);
        platform::Input input;
        std::vector<std::uint8_t> pixels;
        for (int frame = 0; frame < 5; ++frame) {
            context.poll(input);
            CHECK_FALSE(input.close_requested);
            const std::array<float, 4> color = {1.0f, 0.0f, 0.0f, 1.0f};
            glClearNamedFramebufferfv(target->framebuffer.id(), GL_COLOR, 0, color.data());
            (*layer)->begin_frame(context.size_px(), std::chrono::duration<double>(0.016));
            ImGui::SetNextWindowPos({0, 0});
            ImGui::SetNextWindowSize({100, 100});
            ImGui::Begin("HUD");
            ImGui::End();
            (*layer)->draw(target->framebuffer);
            gl::blit_to_window(target->framebuffer, context.size_px());
            pixels = window_pixels(context.size_px());
            context.present();
        }
        // Bottom right: the frame. Top left: the HUD over it.
        const auto size = context.size_px();
        const auto at = [&](int x, int y) { return pixels[static_cast<std::size_t>((y * size.x + x) * 3)]; };
        CHECK(at(size.x - 5, 5) == 255);
        CHECK(at(50, size.y - 50) < 200);
        context.set_mouse_mode(platform::MouseMode::captured);
        context.poll(input);
        CHECK(input.mouse_captured);
        CHECK(input.mouse_motion_px == glm::dvec2(0.0));
        context.set_mouse_mode(platform::MouseMode::free);
    }
    CHECK(gl::debug_error_count() == errors_before);
}

TEST_CASE("windows can be opened one after another") {
    if (std::getenv("DISPLAY") == nullptr) return;
    for (int i = 0; i < 3; ++i) CHECK(platform::open_window({.size_px = {64, 64}}));
}

}  // namespace
}  // namespace ridgeline
