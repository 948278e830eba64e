// How many triangles a view draws, and the pixel error at which it draws so many.
//
// One thread at a time.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "ridgeline/app/options.h"
#include "ridgeline/io/store.h"
#include "ridgeline/platform/camera.h"
#include "ridgeline/select/criterion.h"
#include "ridgeline/select/selection.h"

namespace ridgeline::app {

// With everything there and nothing left out. Reads nothing but the store's records; the store outlives it.
class ViewTriangles {
  public:
    explicit ViewTriangles(const io::Store& store, const select::CriterionOptions& options = {});

    double count(const platform::Camera& camera, double pixel_error_px);

  private:
    std::unique_ptr<select::Criterion> criterion_;
    select::Selection selection_;
    std::vector<io::NodeResidency> residency_;
};

// The greatest pixel error within the range that draws no fewer triangles, or the least one where none does.
// triangles_at: by pixel error; falls as it grows.
double pixel_error_for(double triangles, Range<double> pixel_errors,
                       const std::function<double(double pixel_error_px)>& triangles_at);

}  // namespace ridgeline::app
