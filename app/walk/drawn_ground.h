// The ground of a store as a walk draws it at last: the finest triangulation, exaggerated, as a function of
// the place, and the box that it fills. Paths are laid over it.
//
// Blocks on reads: before the first frame only. One thread at a time; the store outlives it.
#pragma once

#include <optional>

#include "ridgeline/base/geometry.h"
#include "ridgeline/base/result.h"
#include "ridgeline/io/store.h"
#include "ridgeline/platform/camera_controller.h"
#include "ridgeline/select/surface_query.h"

namespace ridgeline::app {

Box terrain_box(const io::TerrainInfo& info, double exaggeration);

class DrawnGround {
  public:
    DrawnGround(const io::Store& store, double exaggeration);

    // Which must not outlive this. Nothing at nodata, outside, and where a read failed.
    platform::GroundFunction function();
    // The first read that failed.
    const std::optional<Error>& failure() const { return failure_; }

  private:
    std::optional<double> height(const glm::dvec2& place);

    select::FinestSurface surface_;
    double offset_m_;
    double exaggeration_;
    std::optional<Error> failure_;
};

}  // namespace ridgeline::app
