#include "ridgeline/platform/camera_controller.h"

#include <algorithm>
#include <cmath>

namespace ridgeline::platform {

namespace {

// +1, -1, or 0 for a pair of opposite keys.
double axis(const Input& input, Key positive, Key negative) {
    return (input.down(positive) ? 1.0 : 0.0) - (input.down(negative) ? 1.0 : 0.0);
}

// Motion of the frame in which a button went down was on the way to where it did.
bool drags(const Input& input, MouseButton button) { return input.down(button) && !input.pressed(button); }

bool looks(const Input& input) {
    return input.mouse_captured || drags(input, MouseButton::left) || drags(input, MouseButton::right);
}

Pose turned(Pose pose, const Controls& controls, const ControllerOptions& options) {
    pose.heading = shortest_turn(Angle(), pose.heading + controls.turn);
    const Angle pitch = pose.pitch + controls.tilt;
    pose.pitch = std::clamp(pitch, options.max_pitch * -1.0, options.max_pitch);
    return pose;
}

double changed_speed(double speed_m_per_s, const Controls& controls, const ControllerOptions& options) {
    return std::clamp(speed_m_per_s * std::pow(options.speed_step_factor, controls.speed_steps),
                      options.min_speed_m_per_s, options.max_speed_m_per_s);
}

// What the velocity tends to. Walking goes where the heading points, however far up or down the eye looks.
glm::dvec3 wanted_velocity(const MotionState& state, const Controls& controls,
                           const ControllerOptions& options) {
    const bool walks = state.mode == MotionMode::walk;
    const Pose level{.heading = state.pose.heading};
    glm::dvec3 direction = controls.move.x * right(state.pose) +
                           controls.move.y * forward(walks ? level : state.pose) +
                           (walks ? 0.0 : controls.move.z) * glm::dvec3(0.0, 0.0, 1.0);
    // Two keys at once are not faster than one.
    direction /= std::max(1.0, glm::length(direction));
    const double sprint = controls.pace == Pace::sprint ? options.sprint_factor : 1.0;
    return direction * state.speed_m_per_s * sprint;
}

}  // namespace

Controls controls_from(const Input& input, const ControllerOptions& options) {
    Controls controls;
    controls.move = {axis(input, Key::d, Key::a), axis(input, Key::w, Key::s), axis(input, Key::e, Key::q)};
    if (looks(input)) {
        controls.turn = options.turn_per_pixel * input.mouse_motion_px.x;
        controls.tilt = options.turn_per_pixel * -input.mouse_motion_px.y;
    }
    controls.speed_steps = input.wheel_steps;
    controls.pace = input.down(Key::shift) ? Pace::sprint : Pace::normal;
    return controls;
}

MotionState step(const MotionState& state, const Controls& controls, const ControllerOptions& options,
                 const GroundFunction& ground, std::chrono::duration<double> dt) {
    RIDGELINE_CHECK(dt.count() >= 0.0);
    MotionState next = state;
    next.pose = turned(state.pose, controls, options);
    next.speed_m_per_s = changed_speed(state.speed_m_per_s, controls, options);

    // dv/dt = (wanted - v) / lag, solved exactly: two half steps go as far as a whole one.
    const glm::dvec3 wanted = wanted_velocity(next, controls, options);
    const double lag_s = options.lag.count();
    const double left = lag_s > 0.0 ? std::exp(-dt.count() / lag_s) : 0.0;
    const glm::dvec3 excess = state.velocity_m_per_s - wanted;
    next.velocity_m_per_s = wanted + excess * left;
    next.pose.eye_m += wanted * dt.count() + excess * (lag_s * (1.0 - left));

    if (state.mode == MotionMode::walk) {
        next.pose.eye_m.z = state.pose.eye_m.z;
        next.velocity_m_per_s.z = 0.0;
        if (const auto height = ground(glm::dvec2(next.pose.eye_m)))
            next.pose.eye_m.z = *height + options.eye_above_ground_m;
    }
    return next;
}

}  // namespace ridgeline::platform
