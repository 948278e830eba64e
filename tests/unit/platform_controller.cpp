#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "ridgeline/platform/camera_controller.h"

namespace ridgeline::platform {
namespace {

using Seconds = std::chrono::duration<double>;

std::optional<double> hills(const glm::dvec2& place) {
    return 100.0 * std::sin(place.x / 300.0) + place.y * 0.01;
}
std::optional<double> no_ground(const glm::dvec2&) { return std::nullopt; }

void press(Input& input, Key key) { input.keys_down.set(static_cast<std::size_t>(key)); }

TEST_CASE("the flight does not depend on the frame rate") {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const ControllerOptions options;
    for (int i = 0; i < 200; ++i) {
        MotionState start;
        start.velocity_m_per_s = glm::dvec3(uniform(random), uniform(random), uniform(random)) * 500.0;
        Controls controls;
        controls.move = {uniform(random), uniform(random), uniform(random)};
        const auto whole = step(start, controls, options, no_ground, Seconds(0.1));
        MotionState parts = start;
        for (int k = 0; k < 7; ++k) parts = step(parts, controls, options, no_ground, Seconds(0.1 / 7));
        CHECK(glm::distance(whole.pose.eye_m, parts.pose.eye_m) < 1e-9);
        CHECK(glm::distance(whole.velocity_m_per_s, parts.velocity_m_per_s) < 1e-9);
    }
}

TEST_CASE("held keys bring the flight to its speed, two keys no faster than one") {
    const ControllerOptions options;
    Input input;
    press(input, Key::w);
    MotionState state;
    const auto settle = [&] {
        for (int i = 0; i < 200; ++i)
            state = step(state, controls_from(input, options), options, no_ground, Seconds(1.0 / 60));
        return glm::length(state.velocity_m_per_s);
    };
    CHECK(settle() == doctest::Approx(state.speed_m_per_s));
    CHECK(state.pose.eye_m.y > 0.0);
    press(input, Key::d);
    CHECK(settle() == doctest::Approx(state.speed_m_per_s));
    press(input, Key::shift);
    CHECK(settle() == doctest::Approx(state.speed_m_per_s * options.sprint_factor));
    input.keys_down.reset();
    CHECK(settle() < 1e-3);
}

TEST_CASE("walking keeps the eye two metres above the ground, wherever it looks") {
    const ControllerOptions options;
    Input input;
    press(input, Key::w);
    press(input, Key::e);
    MotionState state;
    state.mode = MotionMode::walk;
    state.pose.pitch = Angle::from_degrees(60);
    for (int i = 0; i < 500; ++i) {
        input.mouse_captured = true;
        input.mouse_motion_px = {3.0, 0.5};
        state = step(state, controls_from(input, options), options, hills, Seconds(1.0 / 60));
        CHECK(state.pose.eye_m.z == doctest::Approx(*hills(glm::dvec2(state.pose.eye_m)) + 2.0));
    }
    CHECK(glm::length(glm::dvec2(state.velocity_m_per_s)) ==
          doctest::Approx(state.speed_m_per_s).epsilon(0.02));
}

TEST_CASE("walking out of the data keeps the height") {
    MotionState state;
    state.mode = MotionMode::walk;
    state.pose.eye_m.z = 77.0;
    Controls controls;
    controls.move.y = 1.0;
    state = step(state, controls, {}, no_ground, Seconds(1.0));
    CHECK(state.pose.eye_m.z == 77.0);
    CHECK(state.pose.eye_m.y > 0.0);
}

TEST_CASE("the mouse looks only while captured or held, and pitch stops short of straight up and down") {
    const ControllerOptions options;
    Input input;
    input.mouse_motion_px = {100.0, -5000.0};
    CHECK(controls_from(input, options).turn == Angle());
    input.buttons_down.set(static_cast<std::size_t>(MouseButton::right));
    // What moved in the frame of the press was on the way to it.
    input.buttons_pressed.set(static_cast<std::size_t>(MouseButton::right));
    CHECK(controls_from(input, options).turn == Angle());
    input.buttons_pressed.reset();
    const Controls controls = controls_from(input, options);
    CHECK(controls.turn.degrees() == doctest::Approx(12.0));
    const MotionState state = step({}, controls, options, no_ground, Seconds(0.016));
    CHECK(state.pose.heading.degrees() == doctest::Approx(12.0));
    CHECK(state.pose.pitch == options.max_pitch);
}

TEST_CASE("the wheel multiplies the speed within its limits") {
    const ControllerOptions options;
    Controls faster;
    faster.speed_steps = 1.0;
    MotionState state;
    const double before = state.speed_m_per_s;
    state = step(state, faster, options, no_ground, Seconds(0.01));
    CHECK(state.speed_m_per_s == doctest::Approx(before * options.speed_step_factor));
    faster.speed_steps = 1000.0;
    CHECK(step(state, faster, options, no_ground, Seconds(0.01)).speed_m_per_s == options.max_speed_m_per_s);
    faster.speed_steps = -1000.0;
    CHECK(step(state, faster, options, no_ground, Seconds(0.01)).speed_m_per_s == options.min_speed_m_per_s);
}

TEST_CASE("a new frame forgets presses and motion and keeps what is held") {
    Input input;
    press(input, Key::w);
    input.keys_pressed.set(3);
    input.mouse_motion_px = {1.0, 2.0};
    input.wheel_steps = 4.0;
    input.text = "x";
    input.resized_to_px = {1, 1};
    begin_frame(input);
    CHECK(input.down(Key::w));
    CHECK(input.keys_pressed.none());
    CHECK(input.mouse_motion_px == glm::dvec2(0.0));
    CHECK(input.wheel_steps == 0.0);
    CHECK(input.text.empty());
    CHECK_FALSE(input.resized_to_px.has_value());
}

}  // namespace
}  // namespace ridgeline::platform
