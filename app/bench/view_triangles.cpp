#include "ridgeline/app/bench/view_triangles.h"

#include <cmath>

#include "ridgeline/app/walk/stage.h"

namespace ridgeline::app {

ViewTriangles::ViewTriangles(const io::Store& store, const select::CriterionOptions& options)
    : criterion_(select::make_criterion("screen_error", options).value()),
      selection_(store.info(), store.records(), *criterion_) {
    for (const io::NodeRecord& record : store.records())
        residency_.push_back({.resident = record.has_data()});
}

double ViewTriangles::count(const platform::Camera& camera, double pixel_error_px) {
    const select::View view = select::make_view(selection_camera(camera), {.pixel_error_px = pixel_error_px});
    return static_cast<double>(selection_.run(view, residency_).counters.triangles);
}

double pixel_error_for(double triangles, Range<double> pixel_errors,
                       const std::function<double(double pixel_error_px)>& triangles_at) {
    // Of the range's logarithm: of a factor of a hundred, a part in a hundred thousand is left.
    constexpr int kHalvings = 18;
    if (triangles_at(pixel_errors.most) >= triangles) return pixel_errors.most;
    double low = pixel_errors.least, high = pixel_errors.most;
    for (int i = 0; i < kHalvings; ++i) {
        const double middle = std::sqrt(low * high);
        (triangles_at(middle) >= triangles ? low : high) = middle;
    }
    return low;
}

}  // namespace ridgeline::app
