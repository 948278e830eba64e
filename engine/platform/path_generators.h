// The two built-in paths, `--path orbit` and `--path ground`. Both depend on the data alone, never on chance.
#pragma once

#include "ridgeline/base/geometry.h"
#include "ridgeline/platform/path.h"

namespace ridgeline::platform {

struct OrbitOptions {
    Seconds round{60.0};
    // The ellipse's radii, as a share of the bounds' extents: over the data, so that the far side fills the
    // view.
    double radius_share = 0.35;
    // Height over the highest ground, as a share of the shorter extent: peaks stand up, valleys stay in
    // sight.
    double height_share = 0.09;
};

// Circles over `bounds`, looking at its centre; repeats.
CameraPath orbit_path(const Box& bounds, const OrbitOptions& options = {});

struct GroundPathOptions {
    Seconds round{30.0};
    double speed_m_per_s = 30.0;
    double eye_above_ground_m = 2.0;
    double slope_span_m = 1000.0;  // the distance over which slopes are taken
    std::size_t seed = 1;
};

// A closed walk through country steeper than the median of the data, looking ahead; repeats. Data too small
// for the route or too smooth for a median get the same walk, smaller or anywhere. Fails without any ground.
Result<CameraPath> ground_path(const Box& bounds, const GroundFunction& ground,
                               const GroundPathOptions& options = {});

}  // namespace ridgeline::platform
