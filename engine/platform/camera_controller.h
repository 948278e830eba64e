// Flying and walking: from what the user does to where the camera goes.
//
// A pure function of state, controls, time step and ground: nothing here knows of windows or clocks. Velocity
// follows the keys with a short lag whose integral is exact, so the flight does not depend on the frame rate.
// Keys: WASD move, Q down, E up, Shift is faster, the wheel changes the speed, the mouse looks while captured
// or a button is held.
#pragma once

#include <chrono>
#include <functional>
#include <glm/glm.hpp>
#include <optional>

#include "ridgeline/platform/camera.h"
#include "ridgeline/platform/input.h"

namespace ridgeline::platform {

// The ground's height in metres at (east, north), or nothing where there is no data.
using GroundFunction = std::function<std::optional<double>(const glm::dvec2& east_north_m)>;

enum class MotionMode { fly, walk };
enum class Pace { normal, sprint };

// What the user wants in this frame, independent of keys.
struct Controls {
    glm::dvec3 move{0.0};  // right, forward, up; each in [-1, 1]
    Angle turn;            // clockwise
    Angle tilt;            // up
    double speed_steps = 0.0;
    Pace pace = Pace::normal;
};

struct ControllerOptions {
    Angle turn_per_pixel = Angle::from_degrees(0.12);
    double speed_step_factor = 1.25;
    double sprint_factor = 5.0;
    double min_speed_m_per_s = 1.0;
    double max_speed_m_per_s = 50'000.0;
    double eye_above_ground_m = 2.0;          // walking
    std::chrono::duration<double> lag{0.12};  // velocity reaches 63 % of what is asked for after this
    Angle max_pitch = Angle::from_degrees(89.0);
};

struct MotionState {
    MotionMode mode = MotionMode::fly;
    Pose pose;
    glm::dvec3 velocity_m_per_s{0.0};
    double speed_m_per_s = 300.0;
};

Controls controls_from(const Input& input, const ControllerOptions& options);

// One step of `dt` >= 0. Walking stands on `ground` exactly; without data there, at the height it had. Flying
// ignores it.
MotionState step(const MotionState& state, const Controls& controls, const ControllerOptions& options,
                 const GroundFunction& ground, std::chrono::duration<double> dt);

}  // namespace ridgeline::platform
