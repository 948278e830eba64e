// Catmull-Rom splines with uneven knots after P. J. Barry and R. N. Goldman, "A recursive evaluation
// algorithm for a class of Catmull-Rom splines" (SIGGRAPH 1988): here in Hermite form, the knots being the
// samples' times, so that the speed along the path is what the times say. At the ends of a path that holds,
// the tangent is the first (last) chord.
#include "ridgeline/platform/path.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace ridgeline::platform {

namespace {

// A sample with both of its heights known: over the datum and over the ground.
struct Knot {
    double t_s = 0.0;
    glm::dvec4 place{0.0};  // east, north, height, above ground; metres
    glm::dvec4 tangent{0.0};
    HeightReference reference = HeightReference::absolute;
    Angle heading;
    Angle pitch;
};

// The ground along a path; over a gap in the data it stays what it last was.
class GroundBelow {
  public:
    explicit GroundBelow(const GroundFunction& ground) : ground_(ground) {}

    double at(const glm::dvec2& east_north_m) {
        if (const auto height = ground_(east_north_m)) last_m_ = *height;
        return last_m_;
    }
    void start_from(double height_m) { last_m_ = height_m; }

  private:
    const GroundFunction& ground_;
    double last_m_ = 0.0;
};

bool follows_ground(const CameraPath& path) {
    return std::ranges::any_of(
        path.samples, [](const PathSample& s) { return s.reference == HeightReference::above_ground; });
}

std::optional<double> first_ground(const CameraPath& path, const GroundFunction& ground) {
    for (const auto& sample : path.samples)
        if (const auto height = ground(glm::dvec2(sample.pose.eye_m))) return height;
    return std::nullopt;
}

std::vector<Knot> make_knots(const CameraPath& path, GroundBelow* ground) {
    std::vector<Knot> knots;
    knots.reserve(path.samples.size());
    for (const auto& [t, pose, reference] : path.samples) {
        const double below = ground != nullptr ? ground->at(glm::dvec2(pose.eye_m)) : 0.0;
        const bool relative = reference == HeightReference::above_ground;
        const double height = relative ? below + pose.eye_m.z : pose.eye_m.z;
        knots.push_back({.t_s = (t - path.samples.front().t).count(),
                         .place = {pose.eye_m.x, pose.eye_m.y, height, height - below},
                         .reference = reference,
                         .heading = pose.heading,
                         .pitch = pose.pitch});
    }
    return knots;
}

glm::dvec4 slope(const Knot& from, const Knot& to) { return (to.place - from.place) / (to.t_s - from.t_s); }

// The derivative of Barry and Goldman's spline at `here`.
glm::dvec4 tangent_between(const Knot& before, const Knot& here, const Knot& after) {
    return slope(before, here) - slope(before, after) + slope(here, after);
}

void set_tangents(std::vector<Knot>& knots, PathEnd end) {
    const std::size_t last = knots.size() - 1;
    if (last == 0) return;
    for (std::size_t i = 1; i < last; ++i)
        knots[i].tangent = tangent_between(knots[i - 1], knots[i], knots[i + 1]);
    knots[0].tangent = slope(knots[0], knots[1]);
    knots[last].tangent = slope(knots[last - 1], knots[last]);
    if (end == PathEnd::hold || last == 1) return;
    Knot after_last = knots[1];
    after_last.t_s += knots[last].t_s;
    knots[last].tangent = tangent_between(knots[last - 1], knots[last], after_last);
    knots[0].tangent = knots[last].tangent;
}

glm::dvec4 hermite(const Knot& from, const Knot& to, double share) {
    const double length_s = to.t_s - from.t_s;
    const double s2 = share * share;
    const double s3 = s2 * share;
    return from.place * (2.0 * s3 - 3.0 * s2 + 1.0) + to.place * (3.0 * s2 - 2.0 * s3) +
           (from.tangent * (s3 - 2.0 * s2 + share) + to.tangent * (s3 - s2)) * length_s;
}

Angle between(Angle from, Angle to, double share) { return from + shortest_turn(from, to) * share; }

double height_between(const Knot& from, const Knot& to, const glm::dvec4& place, GroundBelow* ground) {
    const bool on_ground =
        from.reference == HeightReference::above_ground && to.reference == HeightReference::above_ground;
    if (!on_ground) return place.z;
    // A spline swings out before it rises; near the ground that would be into it.
    return ground->at(glm::dvec2(place)) + std::max(place.w, std::min(from.place.w, to.place.w));
}

// The poses of a path at times that increase.
class Evaluator {
  public:
    Evaluator(std::vector<Knot> knots, GroundBelow* ground) : knots_(std::move(knots)), ground_(ground) {}

    Pose at(double t_s) {
        while (next_ + 1 < knots_.size() && knots_[next_].t_s <= t_s) ++next_;
        if (next_ == 0 || t_s >= knots_.back().t_s) return pose_of(knots_.back());
        const Knot& from = knots_[next_ - 1];
        const Knot& to = knots_[next_];
        const double share = (t_s - from.t_s) / (to.t_s - from.t_s);
        const glm::dvec4 place = hermite(from, to, share);
        return {glm::dvec3(place.x, place.y, height_between(from, to, place, ground_)),
                between(from.heading, to.heading, share), between(from.pitch, to.pitch, share)};
    }

  private:
    static Pose pose_of(const Knot& knot) { return {glm::dvec3(knot.place), knot.heading, knot.pitch}; }

    std::vector<Knot> knots_;
    GroundBelow* ground_;
    std::size_t next_ = 0;
};

// Hold: a frame at every interval and one at the very end. Repeat: the end is the beginning, so without it.
std::size_t count_frames(double duration_s, double interval_s, PathEnd end) {
    // Sixty intervals of 1/60 s are a second, whatever the rounding says.
    const auto intervals = static_cast<std::size_t>(std::ceil(duration_s / interval_s - 1e-6));
    return end == PathEnd::hold ? intervals + 1 : std::max<std::size_t>(intervals, 1);
}

}  // namespace

ResolvedPath::ResolvedPath(std::vector<Pose> poses, Seconds frame_interval, PathEnd end)
    : poses_(std::move(poses)), frame_interval_(frame_interval), end_(end) {
    RIDGELINE_CHECK(!poses_.empty() && frame_interval.count() > 0.0);
}

Seconds ResolvedPath::duration() const {
    const std::size_t intervals = end_ == PathEnd::hold ? poses_.size() - 1 : poses_.size();
    return frame_interval_ * static_cast<double>(intervals);
}

const Pose& ResolvedPath::frame(std::size_t index) const {
    return poses_[end_ == PathEnd::hold ? std::min(index, poses_.size() - 1) : index % poses_.size()];
}

Pose ResolvedPath::at(Seconds time) const {
    RIDGELINE_CHECK(time.count() >= 0.0);
    const double frames = time / frame_interval_;
    const double whole = std::floor(frames);
    const Pose& from = frame(static_cast<std::size_t>(whole));
    const Pose& to = frame(static_cast<std::size_t>(whole) + 1);
    const double share = frames - whole;
    return {glm::mix(from.eye_m, to.eye_m, share), between(from.heading, to.heading, share),
            between(from.pitch, to.pitch, share)};
}

Result<ResolvedPath> resolve(const CameraPath& path, const GroundFunction& ground,
                             const ResolveOptions& options) {
    RIDGELINE_CHECK(!path.samples.empty());
    std::optional<GroundBelow> below;
    if (follows_ground(path)) {
        const auto first = first_ground(path, ground);
        if (!first) return Error{"path: follows the ground, but never comes over the data"};
        below.emplace(ground);
        below->start_from(*first);
    }
    GroundBelow* const under = below ? &*below : nullptr;
    std::vector<Knot> knots = make_knots(path, under);
    set_tangents(knots, path.end);
    const double duration_s = knots.back().t_s;
    const double interval_s = options.frame_interval.count();
    const std::size_t frames = count_frames(duration_s, interval_s, path.end);
    if (under != nullptr) under->start_from(knots.front().place.z - knots.front().place.w);
    Evaluator evaluator(std::move(knots), under);
    std::vector<Pose> poses(frames);
    for (std::size_t i = 0; i < frames; ++i) poses[i] = evaluator.at(static_cast<double>(i) * interval_s);
    return ResolvedPath(std::move(poses), options.frame_interval, path.end);
}

}  // namespace ridgeline::platform
