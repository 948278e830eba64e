// Where the camera goes: along a path that was settled before the first frame, or as the user steers it.
//
// A value that the render thread steps once a frame. A walk that follows a path can be paused; steering takes
// it over at any time, and it can be sent back. What is shown can be recorded and played again.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "ridgeline/app/options.h"
#include "ridgeline/base/result.h"
#include "ridgeline/io/store.h"
#include "ridgeline/platform/camera_controller.h"
#include "ridgeline/platform/path.h"

namespace ridgeline::app {

using platform::Seconds;

// What time is in a walk: headless, every frame takes the same; in a window, as long as it took.
constexpr Seconds kHeadlessFrameTime{1.0 / 60.0};

// The path as absolute positions, ground under it looked up in the store; reads it, so before the first frame
// only. Heights above ground count from the drawn ground, so with its exaggeration.
Result<platform::ResolvedPath> resolve_course(const io::Store& store, const PathChoice& choice,
                                              double exaggeration);

// From high up, looking over the whole of it: where a walk without a path begins.
platform::Pose overview(const io::TerrainInfo& info, double exaggeration);

class Course {
  public:
    // Follows `path`, or, without one, starts where overview() says and is steered.
    Course(std::optional<platform::ResolvedPath> path, const platform::Pose& start);

    enum class State { steered, following, paused };
    State state() const { return state_; }

    // Headless: the path's pose of this frame.
    void show_frame(std::int64_t frame);
    // In a window: time passes, and the user steers. Steering ends following.
    void advance(const platform::Controls& controls, const platform::GroundFunction& ground, Seconds dt);

    void toggle_pause();
    void toggle_walking();
    // Looks from where it is; steered from now on.
    void go_to(const platform::Pose& pose);
    // Follows a path from its beginning.
    void follow(platform::ResolvedPath path);

    const platform::Pose& pose() const { return motion_.pose; }
    platform::MotionMode mode() const { return motion_.mode; }
    double speed_setting_m_per_s() const { return motion_.speed_m_per_s; }
    // How the last step moved, for paging ahead.
    double speed_m_per_s() const { return speed_m_per_s_; }
    Angle turn_per_second() const { return turn_per_second_; }

  private:
    void note_motion(const platform::Pose& before, Seconds dt);

    std::optional<platform::ResolvedPath> path_;
    Seconds path_time_{0.0};
    State state_;
    platform::MotionState motion_;
    platform::ControllerOptions controller_;
    double speed_m_per_s_ = 0.0;
    Angle turn_per_second_;
};

// What was shown, as a path.
class CourseRecording {
  public:
    void add(Seconds time, const platform::Pose& pose);
    bool empty() const { return path_.samples.empty(); }
    const platform::CameraPath& path() const { return path_; }

  private:
    platform::CameraPath path_;
};

}  // namespace ridgeline::app
