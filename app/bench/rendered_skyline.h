// A still of a store and where the skyline is in it, to the pixel.
//
// Drawn by the frame that walks draw with. Rendering: the render thread, with a GL context current; the rest
// is pure.
#pragma once

#include <vector>

#include "ridgeline/base/result.h"
#include "ridgeline/gl/screenshot.h"
#include "ridgeline/io/store.h"
#include "ridgeline/jobs/job_system.h"
#include "ridgeline/platform/camera.h"
#include "ridgeline/select/view.h"

namespace ridgeline::app {

struct Still {
    gl::Image image;
    // By column of pixels, the first row of ground from the top: 0 where there is no sky, the image's height
    // where there is no ground.
    std::vector<int> skyline;
    double lift_m = 0.0;  // how far the eye had to be lifted over the drawn ground
};

struct StillOptions {
    platform::Camera camera;
    double pixel_error_px = 1.0;
    select::HorizonMode horizon = select::HorizonMode::off;
};

// With all tiles there that the view wants.
Result<Still> take_still(const io::Store& store, jobs::JobSystem& jobs, const StillOptions& options);

// How far one still's skyline is from another's of the same camera.
class SkylineDeviation {
  public:
    SkylineDeviation(const Still& reference, const Still& still);

    // Upwards, in pixels, by column; 0 where either has no skyline.
    const std::vector<int>& upwards_px() const { return upwards_px_; }
    // Of the columns in which both have one; without sign.
    const std::vector<double>& errors_px() const { return errors_px_; }

  private:
    std::vector<int> upwards_px_;
    std::vector<double> errors_px_;
};

}  // namespace ridgeline::app
