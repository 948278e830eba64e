// The window: GLFW, its events gathered into an Input.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <array>
#include <string>
#include <utility>

#include "ridgeline/base/log.h"
#include "ridgeline/base/thread_role.h"
#include "ridgeline/platform/context.h"
#include "ridgeline/platform/gl_version.h"

namespace ridgeline::platform {

namespace {

// glfwGetError would do, but errors outside the calls we check belong in the log as well.
void log_glfw_error(int code, const char* text) {
    log_line(LogLevel::debug, "GLFW error " + std::to_string(code) + ": " + text);
}

std::string last_glfw_error() {
    const char* text = nullptr;
    glfwGetError(&text);
    return text != nullptr ? text : "no reason given";
}

// GLFW is one per process: set up with the first window, taken down with the last.
class GlfwLibrary {
  public:
    static Result<GlfwLibrary> open() {
        glfwSetErrorCallback(log_glfw_error);
        if (users_ == 0 && glfwInit() != GLFW_TRUE)
            return Error{"no display: " + last_glfw_error() + ": use --headless"};
        return GlfwLibrary();
    }
    GlfwLibrary(GlfwLibrary&& other) noexcept : counted_(std::exchange(other.counted_, false)) {}
    GlfwLibrary& operator=(GlfwLibrary&&) = delete;
    ~GlfwLibrary() {
        if (counted_ && --users_ == 0) glfwTerminate();
    }

  private:
    GlfwLibrary() { ++users_; }
    static inline int users_ = 0;
    bool counted_ = true;
};

constexpr std::pair<int, Key> kSpecialKeys[] = {
    {GLFW_KEY_UP, Key::up},
    {GLFW_KEY_DOWN, Key::down},
    {GLFW_KEY_LEFT, Key::left},
    {GLFW_KEY_RIGHT, Key::right},
    {GLFW_KEY_PAGE_UP, Key::page_up},
    {GLFW_KEY_PAGE_DOWN, Key::page_down},
    {GLFW_KEY_HOME, Key::home},
    {GLFW_KEY_END, Key::end},
    {GLFW_KEY_SPACE, Key::space},
    {GLFW_KEY_TAB, Key::tab},
    {GLFW_KEY_ENTER, Key::enter},
    {GLFW_KEY_KP_ENTER, Key::enter},
    {GLFW_KEY_ESCAPE, Key::escape},
    {GLFW_KEY_BACKSPACE, Key::backspace},
    {GLFW_KEY_LEFT_SHIFT, Key::shift},
    {GLFW_KEY_RIGHT_SHIFT, Key::shift},
    {GLFW_KEY_LEFT_CONTROL, Key::control},
    {GLFW_KEY_RIGHT_CONTROL, Key::control},
    {GLFW_KEY_LEFT_ALT, Key::alt},
    {GLFW_KEY_RIGHT_ALT, Key::alt},
};

Key offset_key(Key first, int offset) { return static_cast<Key>(static_cast<int>(first) + offset); }

std::optional<Key> key_of(int glfw_key) {
    if (glfw_key >= GLFW_KEY_A && glfw_key <= GLFW_KEY_Z) return offset_key(Key::a, glfw_key - GLFW_KEY_A);
    if (glfw_key >= GLFW_KEY_0 && glfw_key <= GLFW_KEY_9)
        return offset_key(Key::digit_0, glfw_key - GLFW_KEY_0);
    if (glfw_key >= GLFW_KEY_F1 && glfw_key <= GLFW_KEY_F12)
        return offset_key(Key::f1, glfw_key - GLFW_KEY_F1);
    for (const auto& [from, to] : kSpecialKeys)
        if (from == glfw_key) return to;
    return std::nullopt;
}

std::optional<MouseButton> button_of(int glfw_button) {
    switch (glfw_button) {
        case GLFW_MOUSE_BUTTON_LEFT:
            return MouseButton::left;
        case GLFW_MOUSE_BUTTON_RIGHT:
            return MouseButton::right;
        case GLFW_MOUSE_BUTTON_MIDDLE:
            return MouseButton::middle;
        default:
            return std::nullopt;
    }
}

void append_utf8(std::string& text, unsigned code) {
    const auto put = [&text](unsigned byte) { text.push_back(static_cast<char>(byte)); };
    const auto put_rest = [&](int bits) {
        for (; bits > 0; bits -= 6) put(0x80U | ((code >> (bits - 6)) & 0x3FU));
    };
    if (code < 0x80) return put(code);
    if (code < 0x800) return put(0xC0U | (code >> 6)), put_rest(6);
    if (code < 0x10000) return put(0xE0U | (code >> 12)), put_rest(12);
    put(0xF0U | (code >> 18)), put_rest(18);
}

class WindowContext final : public Context {
  public:
    WindowContext(GlfwLibrary library, GLFWwindow* window) : library_(std::move(library)), window_(window) {
        glfwSetWindowUserPointer(window_, this);
        glfwSetKeyCallback(window_, on_key);
        glfwSetCharCallback(window_, on_character);
        glfwSetMouseButtonCallback(window_, on_mouse_button);
        glfwSetCursorPosCallback(window_, on_mouse_moved);
        glfwSetScrollCallback(window_, on_wheel);
        glfwSetFramebufferSizeCallback(window_, on_resized);
        glfwGetCursorPos(window_, &mouse_px_.x, &mouse_px_.y);
    }
    ~WindowContext() override { glfwDestroyWindow(window_); }

    void make_current() override { glfwMakeContextCurrent(window_); }
    void present() override { glfwSwapBuffers(window_); }

    void poll(Input& input) override {
        RIDGELINE_ASSERT_ROLE(render);
        begin_frame(input);
        polled_ = &input;
        glfwPollEvents();
        polled_ = nullptr;
        // The pointer jumps with the mode; that is no motion.
        if (std::exchange(mouse_mode_changed_, false)) input.mouse_motion_px = {};
        input.mouse_position_px = mouse_px_;
        input.mouse_captured = mouse_mode_ == MouseMode::captured;
        input.close_requested = glfwWindowShouldClose(window_) == GLFW_TRUE;
    }

    void set_mouse_mode(MouseMode mode) override {
        if (mode == mouse_mode_) return;
        mouse_mode_ = mode;
        mouse_mode_changed_ = true;
        glfwSetInputMode(window_, GLFW_CURSOR,
                         mode == MouseMode::captured ? GLFW_CURSOR_DISABLED : GLFW_CURSOR_NORMAL);
    }

    glm::ivec2 size_px() const override {
        glm::ivec2 size{0};
        glfwGetFramebufferSize(window_, &size.x, &size.y);
        return size;
    }
    GlLoader gl_loader() const override { return glfwGetProcAddress; }
    std::string description() const override {
        return std::string("window (GLFW ") + glfwGetVersionString() + ")";
    }
    GLFWwindow* glfw_window() const override { return window_; }

  private:
    // The input being polled into; null for events outside poll(), which then count for no frame.
    static Input* target(GLFWwindow* window) { return self(window).polled_; }
    static WindowContext& self(GLFWwindow* window) {
        return *static_cast<WindowContext*>(glfwGetWindowUserPointer(window));
    }

    template <class Bits>
    static void note(int action, std::size_t index, Bits& down, Bits& pressed) {
        if (action == GLFW_PRESS) pressed.set(index);
        if (action != GLFW_REPEAT) down.set(index, action == GLFW_PRESS);
    }

    static void on_key(GLFWwindow* window, int glfw_key, int, int action, int) {
        Input* input = target(window);
        const auto key = key_of(glfw_key);
        if (input != nullptr && key)
            note(action, static_cast<std::size_t>(*key), input->keys_down, input->keys_pressed);
    }
    static void on_mouse_button(GLFWwindow* window, int glfw_button, int action, int) {
        Input* input = target(window);
        const auto button = button_of(glfw_button);
        if (input != nullptr && button)
            note(action, static_cast<std::size_t>(*button), input->buttons_down, input->buttons_pressed);
    }
    static void on_character(GLFWwindow* window, unsigned code) {
        if (Input* input = target(window)) append_utf8(input->text, code);
    }
    static void on_mouse_moved(GLFWwindow* window, double x, double y) {
        const glm::dvec2 position(x, y);
        const glm::dvec2 before = std::exchange(self(window).mouse_px_, position);
        if (Input* input = target(window)) input->mouse_motion_px += position - before;
    }
    static void on_wheel(GLFWwindow* window, double, double steps) {
        if (Input* input = target(window)) input->wheel_steps += steps;
    }
    static void on_resized(GLFWwindow* window, int width, int height) {
        if (Input* input = target(window)) input->resized_to_px = glm::ivec2(width, height);
    }

    GlfwLibrary library_;
    GLFWwindow* window_;
    Input* polled_ = nullptr;
    MouseMode mouse_mode_ = MouseMode::free;
    bool mouse_mode_changed_ = false;
    glm::dvec2 mouse_px_{0.0};
};

enum class Request { core_4_5, whatever_there_is };

GLFWwindow* create_window(const WindowOptions& options, Request request) {
    glfwDefaultWindowHints();
    if (request == Request::core_4_5) {
        glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
        glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
        glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    } else {
        glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
    }
    glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, options.debug == ContextDebug::on ? GLFW_TRUE : GLFW_FALSE);
    // The frame is drawn off-screen and copied: the window needs colour alone.
    glfwWindowHint(GLFW_DEPTH_BITS, 0);
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
    return glfwCreateWindow(options.size_px.x, options.size_px.y, options.title.c_str(), nullptr, nullptr);
}

// Why no 4.5 window came to be: what the machine has instead, or GLFW's own words.
Error window_error(const WindowOptions& options) {
    const std::string reason = last_glfw_error();
    GLFWwindow* window = create_window(options, Request::whatever_there_is);
    if (window == nullptr) return Error{"no window: " + reason + ": use --headless"};
    glfwMakeContextCurrent(window);
    const GlVersion found = read_gl_version(glfwGetProcAddress);
    glfwDestroyWindow(window);
    return found.enough() ? Error{"no window: " + reason + ": use --headless"} : too_old(found);
}

}  // namespace

Result<std::unique_ptr<Context>> open_window(const WindowOptions& options) {
    RIDGELINE_ASSERT_ROLE(render);
    RIDGELINE_CHECK(options.size_px.x > 0 && options.size_px.y > 0);
    auto library = GlfwLibrary::open();
    if (!library) return library.error();
    GLFWwindow* window = create_window(options, Request::core_4_5);
    if (window == nullptr) return window_error(options);
    glfwMakeContextCurrent(window);
    glfwSwapInterval(options.vertical_sync == VerticalSync::on ? 1 : 0);
    return std::unique_ptr<Context>(std::make_unique<WindowContext>(std::move(*library), window));
}

}  // namespace ridgeline::platform
