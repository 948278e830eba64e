#include "ridgeline/app/walk/course.h"

#include <algorithm>
#include <cmath>

#include "ridgeline/app/walk/drawn_ground.h"
#include "ridgeline/platform/path_generators.h"

namespace ridgeline::app {
namespace {

Result<platform::CameraPath> chosen_path(const PathChoice& choice, const Box& bounds,
                                         const platform::GroundFunction& ground) {
    if (choice.kind == PathChoice::Kind::file) return platform::load_path(choice.file);
    if (choice.kind == PathChoice::Kind::ground) return platform::ground_path(bounds, ground);
    return platform::orbit_path(bounds);
}

// Keys, wheel and mouse at rest.
bool at_rest(const platform::Controls& controls) {
    return controls.move == glm::dvec3(0.0) && controls.turn == Angle() && controls.tilt == Angle();
}

}  // namespace

Result<platform::ResolvedPath> resolve_course(const io::Store& store, const PathChoice& choice,
                                              double exaggeration) {
    DrawnGround ground(store, exaggeration);
    const auto path = chosen_path(choice, terrain_box(store.info(), exaggeration), ground.function());
    if (!path) return ground.failure().value_or(path.error());
    auto resolved = platform::resolve(*path, ground.function(), {.frame_interval = kHeadlessFrameTime});
    if (ground.failure()) return *ground.failure();
    return resolved;
}

platform::Pose overview(const io::TerrainInfo& info, double exaggeration) {
    const Box bounds = terrain_box(info, exaggeration);
    const glm::dvec3 centre = 0.5 * (bounds.min + bounds.max);
    const glm::dvec3 size = bounds.max - bounds.min;
    // From the south, as maps are looked at; over the edge, so that most of the picture is terrain.
    const glm::dvec3 eye(centre.x, bounds.min.y + 0.08 * size.y,
                         bounds.max.z + 0.16 * std::max(size.x, size.y));
    return platform::looking_along(eye, glm::dvec3(centre.x, centre.y, bounds.min.z) - eye);
}

Course::Course(std::optional<platform::ResolvedPath> path, const platform::Pose& start)
    : path_(std::move(path)), state_(path_ ? State::following : State::steered) {
    motion_.pose = path_ ? path_->frame(0) : start;
}

void Course::show_frame(std::int64_t frame) {
    const platform::Pose before = motion_.pose;
    motion_.pose = path_->frame(static_cast<std::size_t>(frame));
    if (frame > 0) note_motion(before, kHeadlessFrameTime);
}

void Course::advance(const platform::Controls& controls, const platform::GroundFunction& ground, Seconds dt) {
    const platform::Pose before = motion_.pose;
    if (state_ != State::steered && !at_rest(controls)) state_ = State::steered;
    if (state_ == State::following) {
        path_time_ += dt;
        motion_.pose = path_->at(path_time_);
        motion_.velocity_m_per_s = glm::dvec3(0.0);
    } else if (state_ == State::steered) {
        motion_ = platform::step(motion_, controls, controller_, ground, dt);
    }
    note_motion(before, dt);
}

void Course::note_motion(const platform::Pose& before, Seconds dt) {
    if (dt.count() <= 0.0) return;
    speed_m_per_s_ = glm::length(motion_.pose.eye_m - before.eye_m) / dt.count();
    const double heading = platform::shortest_turn(before.heading, motion_.pose.heading).radians();
    const double pitch = (motion_.pose.pitch - before.pitch).radians();
    turn_per_second_ = Angle::from_radians(std::hypot(heading, pitch) / dt.count());
}

void Course::toggle_pause() {
    if (state_ == State::following)
        state_ = State::paused;
    else if (path_)
        state_ = State::following;
}

void Course::toggle_walking() {
    const bool flies = motion_.mode == platform::MotionMode::fly;
    motion_.mode = flies ? platform::MotionMode::walk : platform::MotionMode::fly;
    if (flies) {
        // A brisk march, not the speed of a flight; and looking ahead, not down.
        constexpr double kMarch_m_per_s = 10.0;
        motion_.speed_m_per_s = std::min(motion_.speed_m_per_s, kMarch_m_per_s);
        motion_.pose.pitch = Angle();
    }
    state_ = State::steered;
}

void Course::go_to(const platform::Pose& pose) {
    motion_.pose = pose;
    motion_.velocity_m_per_s = glm::dvec3(0.0);
    state_ = State::steered;
}

void Course::follow(platform::ResolvedPath path) {
    path_ = std::move(path);
    path_time_ = Seconds(0.0);
    state_ = State::following;
}

void CourseRecording::add(Seconds time, const platform::Pose& pose) {
    auto& samples = path_.samples;
    if (!samples.empty() && time <= samples.back().t) return;
    samples.push_back({time, pose, platform::HeightReference::absolute});
}

}  // namespace ridgeline::app
