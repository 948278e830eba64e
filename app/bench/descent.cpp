#include "ridgeline/app/bench/descent.h"

#include <algorithm>
#include <cmath>

namespace ridgeline::app {
namespace {

constexpr Angle kPitchAbove = Angle::from_degrees(-60.0), kPitchBelow = Angle::from_degrees(-8.0);

}  // namespace

Descent::Descent(const platform::ResolvedPath& path) {
    double way_m = 0.0;
    for (std::size_t i = 0; i < path.frame_count(); ++i) {
        if (i > 0)
            way_m += glm::distance(glm::dvec2(path.frame(i).eye_m), glm::dvec2(path.frame(i - 1).eye_m));
        poses_.push_back(path.frame(i));
        way_m_.push_back(way_m);
    }
}

DescentMoment Descent::at(double share) const {
    const platform::Seconds now = share * (kDown + kAlong);
    const double down = std::min(now / kDown, 1.0);
    const double fall = std::log(kHighest_m / kLowest_m);
    DescentMoment moment{now, pose_along(std::max((now - kDown).count(), 0.0) * kRun_m_per_s)};
    moment.pose.eye_m.z = kHighest_m * std::exp(-fall * down);
    moment.pose.pitch = kPitchAbove + (kPitchBelow - kPitchAbove) * down;
    moment.speed_m_per_s = down < 1.0 ? moment.pose.eye_m.z * fall / kDown.count() : kRun_m_per_s;
    return moment;
}

// A path that is shorter ends where it ends.
platform::Pose Descent::pose_along(double way_m) const {
    const auto next = std::ranges::upper_bound(way_m_, way_m);
    if (next == way_m_.end()) return poses_.back();
    const auto i = static_cast<std::size_t>(next - way_m_.begin());
    platform::Pose pose = poses_[i - 1];
    const double share = (way_m - way_m_[i - 1]) / (way_m_[i] - way_m_[i - 1]);
    pose.eye_m = glm::mix(pose.eye_m, poses_[i].eye_m, share);
    pose.heading = pose.heading + platform::shortest_turn(pose.heading, poses_[i].heading) * share;
    return pose;
}

}  // namespace ridgeline::app
