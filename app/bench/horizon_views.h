// Random level views held against the visibility oracle: which share of the hidden nodes each variant of the
// horizon culls, and that it culls nothing seen.
//
// Needs no GL. Everything a view wants is in memory when it is judged. One thread at a time.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <unordered_set>
#include <vector>

#include "ridgeline/app/bench/figures.h"
#include "ridgeline/app/bench/horizon_variants.h"
#include "ridgeline/app/bench/resident_chunks.h"
#include "ridgeline/app/bench/visibility_oracle.h"
#include "ridgeline/platform/camera.h"
#include "ridgeline/select/criterion.h"
#include "ridgeline/select/surface_query.h"

namespace ridgeline::app {

struct HorizonViewOptions {
    int views = 120;  // at each height
    platform::Lens lens{.horizontal_fov = Angle::from_degrees(90.0)};
    double pixel_error_px = 1.0;
    std::uint64_t seed = 1;
};

class HorizonViews {
  public:
    // The store outlives it.
    HorizonViews(const io::Store& store, const HorizonViewOptions& options);

    // At the same places whatever the height; figures under PATH/VARIANT (horizon_suite.h). `step` is called
    // after each view.
    Result<void> judge(double above_ground_m, const std::string& path, Figures& figures,
                       const std::function<void()>& step);

  private:
    struct Tally {
        double nodes = 0.0, triangles = 0.0;
        std::int64_t hidden_culled = 0, wrongly_culled = 0;
        std::vector<double> selection_ms;
    };
    struct Truth {
        std::int64_t seen = 0, hidden = 0, unknown = 0;
        double triangles = 0.0;
    };

    Result<std::vector<platform::Pose>> poses(double above_ground_m);
    Result<void> judge(platform::Pose pose);
    Result<void> select_all(platform::Pose& pose);
    void select(std::size_t variant, const platform::Pose& pose);
    void tally_truth(std::span<const JudgedQuarter> judged);
    void tally(std::size_t variant, std::span<const JudgedQuarter> judged);
    void report(const std::string& path, Figures& figures);

    select::View view_of(const platform::Pose& pose, select::HorizonMode mode) const;

    const io::Store& store_;
    const HorizonViewOptions options_;
    ResidentChunks chunks_;
    VisibilityOracle oracle_;
    std::unique_ptr<select::Criterion> criterion_;
    std::array<std::unique_ptr<select::Selection>, kHorizonVariants.size()> selections_;
    std::array<Tally, kHorizonVariants.size()> tallies_;
    Truth truth_;
    // Of the view at hand.
    std::vector<select::DrawEntry> all_draws_;
    std::vector<Sight> node_sights_;            // of these
    std::vector<std::uint8_t> drawn_quarters_;  // by node
    std::unordered_set<select::NodeIndex> wronged_;
};

}  // namespace ridgeline::app
