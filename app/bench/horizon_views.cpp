#include "ridgeline/app/bench/horizon_views.h"

#include <algorithm>
#include <random>

#include "ridgeline/app/walk/stage.h"
#include "ridgeline/telemetry/clock.h"
#include "ridgeline/telemetry/summary.h"

namespace ridgeline::app {
namespace {

using select::DrawEntry;

// Among this many places one has ground, or there is hardly any.
constexpr int kTries = 1000;
// Places keep so far from the raster's border, as a share of its sides.
constexpr double kBorder = 0.02;

double ratio(double part, double whole) { return whole > 0.0 ? part / whole : 0.0; }

// A place's ground: what queries answer, or the drawn surface where that is higher; nothing over nodata.
class Ground {
  public:
    explicit Ground(const io::Store& store) : samples_(store), surface_(store) {}

    Result<std::optional<double>> height(double column, double row) {
        const auto sampled = samples_.height_at(column, row);
        if (!sampled) return sampled.error();
        if (sampled->kind != select::SurfaceHeight::Kind::ground) return std::optional<double>();
        const auto drawn = surface_.height_at(column, row);
        if (!drawn) return drawn.error();
        return std::optional(std::max(sampled->height_m, drawn->value_or(sampled->height_m)));
    }

  private:
    select::SurfaceQuery samples_;
    select::FinestSurface surface_;
};

}  // namespace

HorizonViews::HorizonViews(const io::Store& store, const HorizonViewOptions& options)
    : store_(store),
      options_(options),
      chunks_(store),
      oracle_(store.grid(), store.records(), chunks_),
      criterion_(select::make_criterion("screen_error").value()),
      drawn_quarters_(store.records().size()) {
    for (auto& selection : selections_)
        selection = std::make_unique<select::Selection>(
            store.info(), store.records(), *criterion_,
            select::SelectionOptions{.wanted_capacity = store.records().size()});
}

Result<void> HorizonViews::judge(double above_ground_m, const std::string& path, Figures& figures,
                                 const std::function<void()>& step) {
    tallies_ = {};
    truth_ = {};
    const auto eyes = poses(above_ground_m);
    if (!eyes) return eyes.error();
    for (const platform::Pose& pose : *eyes) {
        RIDGELINE_TRY(judge(pose));
        chunks_.trim();
        step();
    }
    report(path, figures);
    return {};
}

Result<std::vector<platform::Pose>> HorizonViews::poses(double above_ground_m) {
    std::mt19937_64 random(options_.seed);
    const auto uniform = [&](double from, double to) {
        return from + (to - from) * static_cast<double>(random() >> 11) * 0x1p-53;
    };
    const io::TerrainInfo& info = store_.info();
    Ground ground(store_);
    std::vector<platform::Pose> poses;
    for (int i = 0; i < options_.views; ++i)
        for (int tries = 0; tries < kTries; ++tries) {
            const double column = uniform(kBorder, 1.0 - kBorder) * static_cast<double>(info.width - 1);
            const double row = uniform(kBorder, 1.0 - kBorder) * static_cast<double>(info.height - 1);
            const Angle heading = Angle::from_degrees(uniform(0.0, 360.0));
            const auto height_m = ground.height(column, row);
            if (!height_m) return height_m.error();
            if (!*height_m) continue;
            poses.push_back({{info.world(column, row), **height_m + above_ground_m}, heading, Angle()});
            break;
        }
    if (poses.empty()) return Error{store_.directory().string() + ": no ground found to stand on"};
    return poses;
}

Result<void> HorizonViews::judge(platform::Pose pose) {
    RIDGELINE_TRY(select_all(pose));
    const select::SelectionResult& all = selections_.front()->result();
    all_draws_.assign(all.draws.begin(), all.draws.end());
    const LevelView view{glm::normalize(glm::dvec2(platform::forward(pose))),
                         platform::half_tangents(options_.lens)};
    const auto judged = oracle_.judge(all.eye, all_draws_, view);
    tally_truth(judged);
    for (std::size_t i = 0; i < kHorizonVariants.size(); ++i) {
        select(i, pose);
        tally(i, judged);
    }
    return {};
}

// Until all is there that the view wants, and the eye is over what it draws.
Result<void> HorizonViews::select_all(platform::Pose& pose) {
    select::Selection& all = *selections_.front();
    for (int lifts = 0;;) {
        const auto& result =
            all.run(view_of(pose, kHorizonVariants.front().mode), chunks_.residency(), &chunks_);
        const auto brought = chunks_.bring(result);
        if (!brought) return brought.error();
        if (*brought > 0) continue;
        const double lift_m = eye_lift_m(all, chunks_.residency(), chunks_);
        if (lift_m == 0.0 || lifts == kMostLifts) return {};
        pose.eye_m.z += lift_m;
        ++lifts;
    }
}

void HorizonViews::select(std::size_t variant, const platform::Pose& pose) {
    const select::View view = view_of(pose, kHorizonVariants[variant].mode);
    const auto clock = telemetry::ThreadCpuClock::of_this_thread();
    const std::int64_t start_ns = clock.used_ns();
    selections_[variant]->run(view, chunks_.residency(), &chunks_);
    tallies_[variant].selection_ms.push_back(telemetry::milliseconds(clock.used_ns() - start_ns));
}

select::View HorizonViews::view_of(const platform::Pose& pose, select::HorizonMode mode) const {
    return select::make_view(selection_camera({pose, options_.lens}),
                             {.pixel_error_px = options_.pixel_error_px, .horizon = mode});
}

// --- counting

void HorizonViews::tally_truth(std::span<const JudgedQuarter> judged) {
    node_sights_.assign(all_draws_.size(), Sight::outside);
    for (const JudgedQuarter& quarter : judged) {
        Sight& node = node_sights_[static_cast<std::size_t>(quarter.entry - all_draws_.data())];
        node = std::max(node, quarter.sight);
        if (quarter.sight == Sight::seen) truth_.triangles += quarter.triangles;
    }
    truth_.seen += std::ranges::count(node_sights_, Sight::seen);
    truth_.hidden += std::ranges::count(node_sights_, Sight::hidden);
    truth_.unknown += std::ranges::count(node_sights_, Sight::unknown);
}

void HorizonViews::tally(std::size_t variant, std::span<const JudgedQuarter> judged) {
    Tally& tally = tallies_[variant];
    const auto draws = selections_[variant]->result().draws;
    tally.nodes += static_cast<double>(draws.size());
    std::ranges::fill(drawn_quarters_, std::uint8_t{0});
    for (const DrawEntry& entry : draws) drawn_quarters_[entry.index] = entry.quarters;
    for (std::size_t i = 0; i < all_draws_.size(); ++i)
        tally.hidden_culled += node_sights_[i] == Sight::hidden && drawn_quarters_[all_draws_[i].index] == 0;
    wronged_.clear();
    for (const JudgedQuarter& quarter : judged) {
        const bool drawn = (drawn_quarters_[quarter.entry->index] >> quarter.quarter & 1) != 0;
        if (drawn) tally.triangles += quarter.triangles;
        if (!drawn && quarter.sight == Sight::seen) wronged_.insert(quarter.entry->index);
    }
    tally.wrongly_culled += static_cast<std::int64_t>(wronged_.size());
}

void HorizonViews::report(const std::string& path, Figures& figures) {
    const auto views = static_cast<double>(tallies_.front().selection_ms.size());
    for (std::size_t i = 0; i < kHorizonVariants.size(); ++i) {
        const std::string variant = kHorizonVariants[i].on(path);
        Tally& tally = tallies_[i];
        const telemetry::Summary selection_ms = telemetry::summarise(tally.selection_ms);
        figures.set(variant, "views", views);
        figures.set(variant, "oracle_hidden_share",
                    ratio(static_cast<double>(tally.hidden_culled), static_cast<double>(truth_.hidden)));
        figures.set(variant, "wrongly_culled", static_cast<double>(tally.wrongly_culled));
        figures.set(variant, "per_frame.nodes_drawn", tally.nodes / views);
        figures.set(variant, "per_frame.triangles", tally.triangles / views);
        figures.set(variant, "triangles_ratio", ratio(tallies_.front().triangles, tally.triangles));
        figures.set(variant, "oracle_triangles_ratio", ratio(tallies_.front().triangles, truth_.triangles));
        figures.set(variant, "nodes_visible", static_cast<double>(truth_.seen) / views);
        figures.set(variant, "nodes_hidden", static_cast<double>(truth_.hidden) / views);
        figures.set(variant, "nodes_unknown", static_cast<double>(truth_.unknown) / views);
        figures.set(variant, "selection_ms.mean", selection_ms.mean);
        figures.set(variant, "selection_ms.p99", selection_ms.p99);
    }
}

}  // namespace ridgeline::app
