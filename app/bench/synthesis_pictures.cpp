#include "ridgeline/app/bench/synthesis_pictures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>
#include <random>
#include <utility>

#include "ridgeline/app/bench/picture_sheet.h"
#include "ridgeline/app/walk/stage.h"
#include "ridgeline/detail/finer_ground.h"
#include "ridgeline/select/surface_query.h"

namespace ridgeline::app {
namespace {

constexpr int kGrounds = 4, kDivider_px = 4;
constexpr glm::u8vec3 kPaper{255, 255, 255};

// Where to look from, above the highest of the grounds there.
struct View {
    glm::dvec2 place_m{0.0};
    double above_m = 2.0;
    Angle heading, pitch;
};

std::vector<View> views_from(const platform::Pose& start) {
    const glm::dvec2 place(start.eye_m);
    const auto down = [](double degrees) { return Angle::from_degrees(-degrees); };
    return {{place, 2.0, start.heading, down(5.0)},
            {place, 60.0, start.heading, down(20.0)},
            {place, 500.0, start.heading, down(35.0)},
            {place, 1500.0, start.heading, down(89.0)}};
}

// Looks for level ground beside high ground, among random samples and those about them.
class ShoreSearch {
  public:
    explicit ShoreSearch(const io::Store& store) : info_(store.info()), ground_(store) {}

    // From so far to the south that the shore lies in the picture's middle.
    Result<std::optional<View>> find() {
        constexpr int kTries = 4000;
        std::mt19937 random(1);
        const auto along = [&random](std::int64_t samples) {
            const std::int64_t inner = std::max<std::int64_t>(samples - 2 * kReach, 1);
            return kReach + static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(inner));
        };
        double highest_m = 0.0;
        std::optional<View> best;
        for (int i = 0; i < kTries; ++i) {
            const std::int64_t column = along(info_.width), row = along(info_.height);
            const auto relief_m = relief_of_shore(column, row);
            if (!relief_m) return relief_m.error();
            if (*relief_m <= highest_m) continue;
            highest_m = *relief_m;
            const glm::dvec2 shore = info_.world(static_cast<double>(column), static_cast<double>(row));
            best = View{shore - glm::dvec2(0.0, kAway_m), kAbove_m, Angle(), Angle::from_degrees(-20.0)};
        }
        return best;
    }

  private:
    static constexpr std::int64_t kReach = 4;
    static constexpr double kAway_m = 900.0, kAbove_m = 300.0;

    // 0 where not between a third and two thirds of the samples about are level.
    Result<double> relief_of_shore(std::int64_t column, std::int64_t row) {
        std::vector<double> heights_m;
        for (std::int64_t y = row - kReach; y <= row + kReach; ++y)
            for (std::int64_t x = column - kReach; x <= column + kReach; ++x) {
                const auto height = ground_.height_at(static_cast<double>(x), static_cast<double>(y));
                if (!height) return height.error();
                if (height->kind != select::SurfaceHeight::Kind::ground) return 0.0;
                heights_m.push_back(height->height_m);
            }
        std::ranges::sort(heights_m);
        const double low_m = heights_m.front();
        const auto level = std::ranges::count(heights_m, low_m);
        const auto all = static_cast<std::ptrdiff_t>(heights_m.size());
        return 3 * level > all && 3 * level < 2 * all ? heights_m.back() - low_m : 0.0;
    }

    const io::TerrainInfo& info_;
    select::SurfaceQuery ground_;
};

// One of the four.
struct Ground {
    std::string label;
    std::unique_ptr<TerrainStage> stage;
    std::unique_ptr<select::SurfaceQuery> query;
};

class Pictures {
  public:
    Pictures(jobs::JobSystem& jobs, const SynthesisPictureOptions& options)
        : jobs_(jobs), options_(options) {}

    Result<void> add(const io::Store& store, int octaves, const char* what) {
        StageOptions stage_options;
        stage_options.frame.size_px = options_.lens.size_px;
        stage_options.frame.surfaces = render::Surfaces::all;
        stage_options.frame.detail_octaves = octaves;
        stage_options.wait = TileWait::settle;
        auto stage = TerrainStage::create(store, jobs_, stage_options);
        if (!stage) return stage.error();
        std::array<char, 80> label{};
        std::snprintf(label.data(), label.size(), "%s: %.3g m", what,
                      std::ldexp(store.info().spacing_x_m, -octaves));
        grounds_.push_back({label.data(), std::move(*stage),
                            std::make_unique<select::SurfaceQuery>(
                                store, select::SurfaceQueryOptions{.detail_levels = octaves})});
        return {};
    }

    Result<void> draw(const View& view, int number) {
        const auto pose = pose_of(view);
        if (!pose) return pose.error();
        const glm::ivec2 half = options_.lens.size_px;
        PictureSheet sheet(2 * half + kDivider_px, kPaper);
        for (int i = 0; i < kGrounds; ++i) {
            const Ground& ground = grounds_[static_cast<std::size_t>(i)];
            StageMoment moment;
            moment.number = static_cast<std::uint64_t>(number);
            moment.camera = {*pose, options_.lens};
            moment.surface = render::Surface::disc;
            ground.stage->show(moment);
            const glm::ivec2 at = glm::ivec2(i % 2, i / 2) * (half + kDivider_px);
            sheet.lay(gl::read_image(ground.stage->target()), at);
            sheet.label(ground.label, at);
        }
        return gl::write_png(options_.folder / ("synthesis-" + std::to_string(number) + ".png"),
                             sheet.image());
    }

  private:
    Result<platform::Pose> pose_of(const View& view) {
        double highest_m = -std::numeric_limits<double>::infinity();
        for (const Ground& ground : grounds_) {
            const auto height = ground.query->height(view.place_m.x, view.place_m.y);
            if (!height) return height.error();
            if (height->kind == select::SurfaceHeight::Kind::ground)
                highest_m = std::max(highest_m, height->height_m);
        }
        if (std::isinf(highest_m)) return Error{"suite synthesis: no ground where a picture is to be taken"};
        return platform::Pose{{view.place_m, highest_m + view.above_m}, view.heading, view.pitch};
    }

    jobs::JobSystem& jobs_;
    const SynthesisPictureOptions& options_;
    std::vector<Ground> grounds_;
};

}  // namespace

Result<int> draw_synthesis(const io::Store& real, const io::Store& decimated, int octaves,
                           jobs::JobSystem& jobs, const SynthesisPictureOptions& options) {
    const int rate = 1 << octaves;
    Pictures pictures(jobs, options);
    RIDGELINE_TRY(pictures.add(real, 0, "real"));
    RIDGELINE_TRY(pictures.add(decimated, 0, ("1 of " + std::to_string(rate)).c_str()));
    RIDGELINE_TRY(pictures.add(decimated, octaves, "made of it"));
    RIDGELINE_TRY(pictures.add(decimated, detail::most_octaves(decimated.info()), "all levels"));
    std::vector<View> views = views_from(options.start);
    const auto shore = ShoreSearch(decimated).find();
    if (!shore) return shore.error();
    if (*shore) views.push_back(**shore);
    int number = 0;
    for (const View& view : views) RIDGELINE_TRY(pictures.draw(view, ++number));
    return number;
}

}  // namespace ridgeline::app
