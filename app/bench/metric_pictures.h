// Pictures of suite `metric`: one camera, the geometric store's meshes on the left, the cone's on the right,
// as many triangles in both, and how far their skylines are from the source's.
//
//   geometric                 | cone
//   ... where the skylines differ most, magnified, with the source in the middle ...
//   off the source's skyline  | off the source's skyline
//
// Drawn by the frame that walks draw with, larger than it is shown, with the pixel error larger in the same
// measure: the same triangles, but a magnified part is as sharp as the rest. Render thread, with a GL context
// current.
#pragma once

#include <filesystem>
#include <string>

#include "ridgeline/app/bench/figures.h"
#include "ridgeline/base/result.h"
#include "ridgeline/io/store.h"
#include "ridgeline/jobs/job_system.h"
#include "ridgeline/platform/camera.h"

namespace ridgeline::app {

struct MetricPictureOptions {
    std::filesystem::path folder;
    // Of either half.
    platform::Lens lens{.horizontal_fov = Angle::from_degrees(60.0), .size_px = {720, 405}};
    // At one pixel nobody sees a difference: that is what the pixel error is for.
    double pixel_error_px = 8.0;  // of the geometric store, about
    int magnification = 4;
};

class MetricPictures {
  public:
    // The stores are of the same ground and outlive it.
    MetricPictures(const io::Store& geometric, const io::Store& cone, const MetricPictureOptions& options)
        : geometric_(geometric), cone_(cone), options_(options) {}

    // Writes NAME.png. Figures under NAME/geometric and NAME/cone: triangles, pixel_error_px, and, where both
    // the source and the variant have a skyline, skyline_px.mean and .p99 in pixels as shown.
    Result<void> draw(const platform::Pose& pose, const std::string& name, Figures& figures);

    // Of the written pictures.
    static glm::ivec2 size_px(const MetricPictureOptions& options);

  private:
    const io::Store& geometric_;
    const io::Store& cone_;
    const MetricPictureOptions options_;
    jobs::JobSystem jobs_;
};

}  // namespace ridgeline::app
