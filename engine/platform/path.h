// Recorded camera paths: reading, writing, and turning one into a camera per frame.
//
// A path file (format "ridgeline-path-1") is a list of timed samples. Positions run on a Catmull-Rom spline
// whose knots are the samples' times, so every sample is met exactly at its time; angles turn linearly, the
// short way. A stretch between two `above_ground` samples follows the ground between them as well: its height
// at time t is ground(east, north) + above_ground(t). All of that is settled by resolve() before the first
// frame, so the cameras depend on the path and the data alone. Values; any thread.
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "ridgeline/base/geometry.h"
#include "ridgeline/base/result.h"
#include "ridgeline/platform/camera.h"
#include "ridgeline/platform/camera_controller.h"

namespace ridgeline::platform {

using Seconds = std::chrono::duration<double>;

enum class HeightReference { absolute, above_ground };
// hold: past its end the path stays at its last sample. repeat: it starts again; the last sample equals the
// first.
enum class PathEnd { hold, repeat };

struct PathSample {
    Seconds t{0.0};  // within a day of the first sample's
    Pose pose;       // eye_m.z counts from `reference`
    HeightReference reference = HeightReference::absolute;
};

struct CameraPath {
    std::vector<PathSample> samples;  // at least one; t increases
    PathEnd end = PathEnd::hold;
};

// `name` stands for the file in messages.
Result<CameraPath> parse_path(std::string_view json, const std::string& name);
Result<CameraPath> load_path(const std::filesystem::path& file);
std::string path_to_json(const CameraPath& path);
// Written beside the target and renamed: what stands there is always whole.
Result<void> save_path(const CameraPath& path, const std::filesystem::path& file);

struct ResolveOptions {
    Seconds frame_interval{1.0 / 60.0};
};

// One pose per frame, from the path's first sample on.
class ResolvedPath {
  public:
    ResolvedPath(std::vector<Pose> poses, Seconds frame_interval, PathEnd end);

    // Frames until the path ends, or in one round of a repeating path.
    std::size_t frame_count() const { return poses_.size(); }
    Seconds duration() const;
    // Any index: held or repeated past the end.
    const Pose& frame(std::size_t index) const;
    // Between frames by interpolation, for runs on the wall clock; time >= 0 since the path's first sample.
    Pose at(Seconds time) const;

  private:
    std::vector<Pose> poses_;
    Seconds frame_interval_;
    PathEnd end_;
};

// Fails where a path that follows the ground never comes over data. Over gaps it keeps the ground it last
// had.
Result<ResolvedPath> resolve(const CameraPath& path, const GroundFunction& ground,
                             const ResolveOptions& options = {});

}  // namespace ridgeline::platform
