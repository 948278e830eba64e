// Dear ImGui on top of a drawn frame, with a window or without one.
//
// With a window its input comes through GLFW, after ours: a HUD that wants the mouse or the keys says so, and
// the camera then leaves them alone. Without a window it only draws, the same pixels for the same values. One
// layer per program (ImGui keeps global state); render thread only; it must go before the context does.
#pragma once

#include <chrono>
#include <glm/glm.hpp>
#include <memory>

#include "ridgeline/base/result.h"
#include "ridgeline/gl/framebuffer.h"
#include "ridgeline/platform/context.h"

namespace ridgeline::app {

class ImguiLayer {
  public:
    // GL's functions must be loaded (gl::load).
    static Result<std::unique_ptr<ImguiLayer>> create(const platform::Context& context);
    ~ImguiLayer();
    ImguiLayer(const ImguiLayer&) = delete;
    ImguiLayer& operator=(const ImguiLayer&) = delete;

    // After this, ImGui's calls build the HUD of a frame of this size; then draw().
    void begin_frame(const glm::ivec2& size_px, std::chrono::duration<double> dt);
    void draw(const gl::Framebuffer& target);

    // Of a frame, in the units in which mice and panels are placed; pixels but on scaled desktops.
    glm::dvec2 size() const;
    // Whether what the user does now is meant for the HUD.
    bool wants_mouse() const;
    bool wants_keyboard() const;

  private:
    enum class Backend { headless, window };
    explicit ImguiLayer(Backend backend) : backend_(backend) {}
    Backend backend_;
    bool draws_ = false;
};

}  // namespace ridgeline::app
