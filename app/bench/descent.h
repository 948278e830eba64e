// The course of suite `synthesis`: from 5 km over a path's first place down to half a metre in ten seconds, the height
// over the ground falling by the same share in every frame, then along the path at 50 m/s for ten more.
//
// Heights count from the ground of whoever is shown it. A value; any thread.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "ridgeline/platform/path.h"

namespace ridgeline::app {

struct DescentMoment {
    platform::Seconds now{0.0};
    platform::Pose pose;  // eye_m.z counts from the ground
    double speed_m_per_s = 0.0;
};

class Descent {
  public:
    static constexpr double kHighest_m = 5000.0, kLowest_m = 0.5, kRun_m_per_s = 50.0;
    static constexpr platform::Seconds kDown{10.0}, kAlong{10.0};

    explicit Descent(const platform::ResolvedPath& path);

    // share: of the whole course, from 0 to 1.
    DescentMoment at(double share) const;

  private:
    platform::Pose pose_along(double way_m) const;

    std::vector<platform::Pose> poses_;
    std::vector<double> way_m_;  // to each of them
};

}  // namespace ridgeline::app
