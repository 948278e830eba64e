#include "ridgeline/app/bench/skyline_views.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ridgeline::app {
namespace {

// Over the ground, of the low eyes and the high ones.
constexpr double kLow_m = 10.0;
constexpr double kHigh_m = 100.0;
// Where the skyline lies over the picture's middle, as a share of half its height.
constexpr double kSkylineAt = 0.25;

// The best view of one eye.
struct Candidate {
    const Eye* eye = nullptr;
    double above_ground_m = 0.0;
    int first_column = 0;
    double length_px = 0.0;
    double mean_slope = 0.0;
};

class SkylineLength {
  public:
    SkylineLength(const std::vector<SkylinePoint>& points, const SkylineViewOptions& options, double from_m)
        : points_(points), options_(options), from_m_(from_m) {}

    int columns_in_view() const {
        return static_cast<int>(options_.lens.horizontal_fov.radians() / (2.0 * std::numbers::pi) *
                                options_.columns);
    }

    // Of the view that begins with a column.
    Candidate view(int first) const {
        Candidate candidate{.first_column = first};
        const double projection_px = platform::pixels_per_tangent(options_.lens);
        const double column_px = static_cast<double>(options_.lens.size_px.x) / columns_in_view();
        int seen = 0;
        for (int i = first; i < first + columns_in_view(); ++i) {
            const SkylinePoint &a = at(i), &b = at(i + 1);
            if (a.away_m < from_m_ || b.away_m < from_m_) continue;
            // A cliff beside the sky is no more of a skyline than a slope.
            const double step_px = std::min(std::abs(b.slope - a.slope) * projection_px, column_px);
            candidate.length_px += std::hypot(column_px, step_px);
            candidate.mean_slope += a.slope;
            ++seen;
        }
        candidate.mean_slope /= std::max(seen, 1);
        return candidate;
    }

  private:
    const SkylinePoint& at(int column) const {
        return points_[static_cast<std::size_t>(column) % points_.size()];
    }

    const std::vector<SkylinePoint>& points_;
    const SkylineViewOptions& options_;
    double from_m_;
};

Candidate best_of(const io::TerrainInfo& info, const SurfaceField& source, const Eye& eye,
                  const SkylineViewOptions& options) {
    const auto points = skyline(info, source, eye, {.columns = options.columns});
    const SkylineLength length(points, options,
                               options.from_samples * std::max(info.spacing_x_m, info.spacing_y_m));
    Candidate best;
    for (int first = 0; first < options.columns; ++first)
        if (Candidate view = length.view(first); view.length_px > best.length_px) best = view;
    best.eye = &eye;
    best.above_ground_m = eye.height_m - double{source.at_place(eye.column, eye.row)};
    return best;
}

platform::Pose pose_of(const io::TerrainInfo& info, const Candidate& view,
                       const SkylineViewOptions& options) {
    const Angle first = Angle::from_degrees(360.0 * view.first_column / options.columns);
    const double down = kSkylineAt * platform::half_tangents(options.lens).y;
    return {.eye_m = {info.world(view.eye->column, view.eye->row), view.eye->height_m},
            .heading = first + options.lens.horizontal_fov * 0.5,
            .pitch = Angle::from_radians(std::atan(view.mean_slope) - std::atan(down))};
}

}  // namespace

std::vector<platform::Pose> choose_skyline_views(const io::TerrainInfo& info, const SurfaceField& source,
                                                 std::span<const Eye> eyes,
                                                 const SkylineViewOptions& options) {
    std::vector<Candidate> candidates;
    for (const Eye& eye : eyes)
        if (const Candidate best = best_of(info, source, eye, options); best.length_px > 0.0)
            candidates.push_back(best);
    std::ranges::stable_sort(candidates, std::greater(), &Candidate::length_px);
    std::vector<platform::Pose> poses;
    const auto take_first = [&](double least_m, double most_m) {
        const auto found = std::ranges::find_if(candidates, [&](const Candidate& candidate) {
            return candidate.above_ground_m >= least_m && candidate.above_ground_m <= most_m;
        });
        if (found == candidates.end()) return;
        poses.push_back(pose_of(info, *found, options));
        candidates.erase(found);
    };
    constexpr double kAny_m = std::numeric_limits<double>::infinity();
    take_first(-kAny_m, kAny_m);
    take_first(-kAny_m, kLow_m);
    take_first(kHigh_m, kAny_m);
    take_first(-kAny_m, kAny_m);
    return poses;
}

}  // namespace ridgeline::app
