// An OpenGL 4.5 core context and what is around it: a window (GLFW), or none at all (EGL, for servers and
// tests).
//
// Both stand behind one interface, so that the frame does not know which it draws for. A headless context has
// no default framebuffer: the frame is always drawn into a framebuffer object, and copied to the window where
// there is one. A Context belongs to the thread that opened it, the render thread; GL objects must go before
// it does.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <string>

#include "ridgeline/base/result.h"
#include "ridgeline/platform/input.h"

struct GLFWwindow;

namespace ridgeline::platform {

enum class VerticalSync { off, on };

// A debug context reports more through KHR_debug and costs speed; for tests and for hunting errors.
enum class ContextDebug { off, on };

// free: a pointer for buttons. captured: hidden, unbounded, every motion is a turn of the head.
enum class MouseMode { free, captured };

struct WindowOptions {
    std::string title = "Ridgeline";
    glm::ivec2 size_px{1280, 800};
    VerticalSync vertical_sync = VerticalSync::on;
    ContextDebug debug = ContextDebug::off;
};

struct HeadlessOptions {
    glm::ivec2 size_px{1024, 768};  // what size_px() will say; the context itself has no surface
    ContextDebug debug = ContextDebug::off;
};

// The address of a GL function by its name, as loaders want it.
using GlFunction = void (*)();
using GlLoader = GlFunction (*)(const char* name);

class Context {
  public:
    virtual ~Context() = default;
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    // A context is current when it has been opened; needed only where a program has several.
    virtual void make_current() = 0;
    // Shows the drawn frame; returns at once without a window.
    virtual void present() = 0;
    // Reads the events since the last call. Headless: never any.
    virtual void poll(Input& input) = 0;
    virtual void set_mouse_mode(MouseMode mode) = 0;

    // The framebuffer in pixels, which a scaled desktop makes larger than the window.
    virtual glm::ivec2 size_px() const = 0;
    virtual GlLoader gl_loader() const = 0;
    // How it was opened, for logs: "window (GLFW 3.3.8 X11)", "headless (EGL surfaceless)".
    virtual std::string description() const = 0;
    // For the HUD's input only; null without a window.
    virtual GLFWwindow* glfw_window() const = 0;

  protected:
    Context() = default;
};

// Errors name the mend: no display, no OpenGL 4.5 (and what was found instead).
Result<std::unique_ptr<Context>> open_window(const WindowOptions& options);

// Prefers a GPU; LIBGL_ALWAYS_SOFTWARE and Mesa's other variables hold as for every program.
Result<std::unique_ptr<Context>> open_headless(const HeadlessOptions& options);

}  // namespace ridgeline::platform
