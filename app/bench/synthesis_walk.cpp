#include "ridgeline/app/bench/synthesis_walk.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <utility>

#include "ridgeline/detail/finer_ground.h"
#include "ridgeline/select/surface_query.h"

namespace ridgeline::app {
namespace {

enum Variant { kReal, kDecimated, kMade, kDeep, kVariants };
constexpr std::array<const char*, kVariants> kNames = {"real", "decimated", "made", "deep"};

struct Sum {
    double frame_ms = 0.0, make_ms = 0.0, most_share = 0.0;
    double triangles = 0.0, tiles_made = 0.0, most_made = 0.0;
    double uploaded = 0.0;
    std::int64_t frames = 0;

    double per_triangle() const { return frame_ms / triangles; }
};

// One variant: its stage, the ground that it stands upon, and what it came to.
struct Lane {
    std::unique_ptr<WalkLane> walk;
    std::unique_ptr<select::SurfaceQuery> ground;
    double ground_m = 0.0;  // that was under the eye last
    Sum all;
    LaneFrame frame;
    double tiles_made = 0.0, bytes_read = 0.0, bytes_read_now = 0.0;
};

class DescentWalk {
  public:
    DescentWalk(const SynthesisBench& bench, render::Surface surface)
        : bench_(bench), surface_(surface), course_(bench.walk.path) {}

    Result<void> open() {
        for (int variant = 0; variant < kVariants; ++variant) RIDGELINE_TRY(open(variant));
        return {};
    }

    Result<void> run(std::string& csv) {
        for (Lane& lane : lanes_) {
            const auto moment = moment_of(0, lane);
            if (!moment) return moment.error();
            lane.all.uploaded += static_cast<double>(lane.walk->arrive(*moment).bytes_uploaded);
        }
        for (std::int64_t frame = 0; frame < bench_.walk.frames; ++frame) {
            // Each in its turn is the first.
            for (int i = 0; i < kVariants; ++i)
                RIDGELINE_TRY(show(frame, lanes_[at(static_cast<int>((frame + i) % kVariants))]));
            append_row(frame, csv);
            bench_.step();
        }
        return {};
    }

    void report(Figures& figures) {
        for (int variant = 0; variant < kVariants; ++variant) report(variant, figures);
        for (const int variant : {kMade, kDeep}) {
            const Lane& made = lanes_[at(variant)];
            for (const auto& [without, metric] : {std::pair{kDecimated, "us_per_triangle_ratio"},
                                                  std::pair{kReal, "us_per_triangle_to_real"}})
                figures.set(name_of(variant), metric,
                            made.all.per_triangle() / lanes_[at(without)].all.per_triangle());
        }
        for (int variant = 0; variant < kVariants; ++variant)
            figures.set(name_of(variant), "fps_ratio",
                        lanes_[at(kReal)].all.frame_ms / lanes_[at(variant)].all.frame_ms);
    }

  private:
    static std::size_t at(int variant) { return static_cast<std::size_t>(variant); }
    std::string name_of(int variant) const {
        return std::string(surface_ == render::Surface::disc ? "disc/" : "quadtree/") + kNames[at(variant)];
    }
    const io::Store& store_of(int variant) const { return variant == kReal ? bench_.real : bench_.decimated; }
    int octaves_of(int variant) const {
        return variant == kMade   ? bench_.octaves
               : variant == kDeep ? detail::most_octaves(bench_.decimated.info())
                                  : 0;
    }

    Result<void> open(int variant) {
        StageOptions options = bench_.walk.stage_options();
        options.frame.surfaces = render::Surfaces::all;
        options.frame.detail_octaves = octaves_of(variant);
        auto lane = WalkLane::open(store_of(variant), bench_.jobs, options);
        if (!lane) return lane.error();
        lanes_[at(variant)].walk = std::move(*lane);
        lanes_[at(variant)].ground = std::make_unique<select::SurfaceQuery>(
            store_of(variant), select::SurfaceQueryOptions{.detail_levels = octaves_of(variant)});
        return {};
    }

    DescentMoment course_at(std::int64_t frame) const {
        return course_.at(static_cast<double>(frame) / static_cast<double>(bench_.walk.frames));
    }

    Result<StageMoment> moment_of(std::int64_t frame, Lane& lane) {
        const DescentMoment at = course_at(frame);
        const auto under = lane.ground->height(at.pose.eye_m.x, at.pose.eye_m.y);
        if (!under) return under.error();
        if (under->kind == select::SurfaceHeight::Kind::ground) lane.ground_m = under->height_m;
        StageMoment moment;
        moment.number = static_cast<std::uint64_t>(frame);
        moment.camera = {at.pose, bench_.walk.lens};
        moment.camera.pose.eye_m.z += lane.ground_m;
        moment.speed_m_per_s = at.speed_m_per_s;
        moment.now = at.now;
        moment.surface = surface_;
        return moment;
    }

    Result<void> show(std::int64_t frame, Lane& lane) {
        const auto moment = moment_of(frame, lane);
        if (!moment) return moment.error();
        TerrainStage& stage = lane.walk->stage();
        const auto read_before = static_cast<double>(stage.pager().counters().bytes_read);
        lane.frame = lane.walk->show(*moment);
        lane.bytes_read_now = static_cast<double>(stage.pager().counters().bytes_read) - read_before;
        const render::MadeTiles* made = stage.frame().made_tiles();
        lane.tiles_made = made ? made->counters().made : 0.0;
        add(lane, lane.all);
        return {};
    }

    static void add(const Lane& lane, Sum& sum) {
        const StageReport& report = lane.frame.report;
        ++sum.frames;
        sum.frame_ms += lane.frame.frame_ms;
        sum.make_ms += report.make_ms;
        sum.most_share = std::max(sum.most_share, report.make_ms / lane.frame.frame_ms);
        sum.triangles += static_cast<double>(report.surface.triangles);
        sum.tiles_made += lane.tiles_made;
        sum.most_made = std::max(sum.most_made, lane.tiles_made);
        sum.uploaded += static_cast<double>(report.bytes_uploaded);
    }

    void report(int variant, Figures& figures) {
        const Lane& lane = lanes_[at(variant)];
        const std::string name = name_of(variant);
        const auto frames = static_cast<double>(lane.all.frames);
        figures.set(name, "frames", frames);
        figures.set(name, "pixel_error_px", bench_.walk.pixel_error_px);
        figures.set(name, "spacing_m",
                    std::ldexp(store_of(variant).info().spacing_x_m, -octaves_of(variant)));
        lanes_[at(variant)].walk->report(name, figures);
        figures.set(name, "fps_mean", 1000.0 * frames / lane.all.frame_ms);
        figures.set(name, "us_per_triangle", 1000.0 * lane.all.per_triangle());
        figures.set(name, "bytes_uploaded", lane.all.uploaded);
        if (octaves_of(variant) == 0) return;
        figures.set(name, "tiles_made.mean", lane.all.tiles_made / frames);
        figures.set(name, "tiles_made.max", lane.all.most_made);
        figures.set(name, "make_ms.mean", lane.all.make_ms / frames);
        figures.set(name, "make_percent.all", 100.0 * lane.all.make_ms / lane.all.frame_ms);
        figures.set(name, "make_percent.max", 100.0 * lane.all.most_share);
    }

    void append_row(std::int64_t frame, std::string& csv) const {
        const DescentMoment at = course_at(frame);
        std::array<char, 160> text{};
        std::snprintf(text.data(), text.size(), "%s,%lld,%.3f,%.2f",
                      surface_ == render::Surface::disc ? "disc" : "quadtree", static_cast<long long>(frame),
                      at.now.count(), at.pose.eye_m.z);
        csv += text.data();
        for (const Lane& lane : lanes_) {
            std::snprintf(text.data(), text.size(), ",%.3f,%llu,%.0f,%.3f,%.0f,%llu", lane.frame.frame_ms,
                          static_cast<unsigned long long>(lane.frame.report.surface.triangles),
                          lane.tiles_made, lane.frame.report.make_ms, lane.bytes_read_now,
                          static_cast<unsigned long long>(lane.frame.report.bytes_uploaded));
            csv += text.data();
        }
        csv += '\n';
    }

    const SynthesisBench& bench_;
    render::Surface surface_;
    Descent course_;
    std::array<Lane, kVariants> lanes_;
};

}  // namespace

std::string synthesis_csv_header() {
    std::string line = "surface,frame,time_s,above_ground_m";
    for (const char* variant : kNames)
        for (const char* column :
             {"frame_ms", "triangles", "tiles_made", "make_ms", "bytes_read", "bytes_uploaded"})
            line += "," + std::string(variant) + "_" + column;
    return line + "\n";
}

Result<void> walk_down(const SynthesisBench& bench, render::Surface surface, Figures& figures,
                       std::string& csv) {
    DescentWalk walk(bench, surface);
    RIDGELINE_TRY(walk.open());
    RIDGELINE_TRY(walk.run(csv));
    walk.report(figures);
    return {};
}

}  // namespace ridgeline::app
