// What the user did since the last frame, as a plain snapshot: keys, mouse, wheel, text, window events.
//
// Knows nothing of the windowing library, so that controllers are tested by filling one in. Filled by
// Context::poll on the render thread; `down` is the state at the end of the frame, `pressed` also holds what
// was tapped within it.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>

namespace ridgeline::platform {

// clang-format off
enum class Key : std::uint8_t {
    a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w, x, y, z,
    digit_0, digit_1, digit_2, digit_3, digit_4, digit_5, digit_6, digit_7, digit_8, digit_9,
    f1, f2, f3, f4, f5, f6, f7, f8, f9, f10, f11, f12,
    up, down, left, right, page_up, page_down, home, end,
    space, tab, enter, escape, backspace, shift, control, alt,
    count
};
// clang-format on

enum class MouseButton : std::uint8_t { left, right, middle, count };

struct Input {
    std::bitset<static_cast<std::size_t>(Key::count)> keys_down;
    std::bitset<static_cast<std::size_t>(Key::count)> keys_pressed;
    std::bitset<static_cast<std::size_t>(MouseButton::count)> buttons_down;
    std::bitset<static_cast<std::size_t>(MouseButton::count)> buttons_pressed;
    bool mouse_captured = false;
    glm::dvec2 mouse_position_px{0.0};  // from the window's top left, y down
    glm::dvec2 mouse_motion_px{0.0};
    double wheel_steps = 0.0;  // away from the user is positive
    std::string text;          // UTF-8, what was typed
    bool close_requested = false;
    std::optional<glm::ivec2> resized_to_px;  // the framebuffer's new size, in the frame in which it changed

    bool down(Key key) const { return keys_down.test(static_cast<std::size_t>(key)); }
    bool pressed(Key key) const { return keys_pressed.test(static_cast<std::size_t>(key)); }
    bool down(MouseButton button) const { return buttons_down.test(static_cast<std::size_t>(button)); }
    bool pressed(MouseButton button) const { return buttons_pressed.test(static_cast<std::size_t>(button)); }
};

// Forgets what happened once (presses, motion, wheel, text, events) and keeps what lasts (what is held down).
void begin_frame(Input& input);

}  // namespace ridgeline::platform
