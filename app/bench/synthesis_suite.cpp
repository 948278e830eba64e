#include "ridgeline/app/bench/synthesis_suite.h"

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

#include "ridgeline/app/bench/decimated_rows.h"
#include "ridgeline/app/bench/lost_lags.h"
#include "ridgeline/app/bench/synthesis_walk.h"
#include "ridgeline/app/bench/temporary_folder.h"
#include "ridgeline/app/walk/course.h"
#include "ridgeline/build/builder.h"
#include "ridgeline/build/row_builder.h"
#include "ridgeline/detail/finer_ground.h"
#include "ridgeline/select/surface_query.h"

namespace ridgeline::app {
namespace {

constexpr int kOctaves = 3, kStep = 1 << kOctaves;
constexpr render::Surface kSurfaces[] = {render::Surface::disc, render::Surface::quadtree};

bool foretells_bumps(const io::TerrainInfo& info) {
    return detail::most_octaves(info) >= kOctaves &&
           std::ranges::any_of(info.detail->octaves,
                               [](const io::DetailGains& gains) { return gains != io::DetailGains{}; });
}

Result<io::Store> decimate(const io::Store& from, const std::filesystem::path& folder) {
    build::BuildOptions options;
    options.tile = from.info().tile;
    options.out = folder / "decimated.terrain";
    DecimatedRows rows(from, kStep);
    const auto built = build::build_from_rows(rows, options);
    if (!built) return built.error();
    auto store = io::Store::open(options.out);
    if (store && !foretells_bumps(store->info()))
        return Error{
            "suite synthesis: an eighth of the terrain's samples foretells nothing: it is too small, or "
            "level"};
    return store;
}

// Of neighbouring samples of the real ground; empty where one of them is none.
Result<std::vector<double>> block_of(select::SurfaceQuery& query, const glm::ivec2& first, int side,
                                     int step) {
    std::vector<double> heights_m;
    for (int row = 0; row < side; ++row)
        for (int column = 0; column < side; ++column) {
            const glm::dvec2 place = glm::dvec2(first + glm::ivec2(column, row)) / static_cast<double>(step);
            const auto height = query.height_at(place.x, place.y);
            if (!height) return height.error();
            if (height->kind != select::SurfaceHeight::Kind::ground) return std::vector<double>();
            heights_m.push_back(height->height_m);
        }
    return heights_m;
}

class Suite {
  public:
    Suite(const io::Store& real, const io::Store& decimated, const SynthesisSuiteOptions& options)
        : real_(real),
          decimated_(decimated),
          options_(options),
          total_(options.frames * static_cast<std::int64_t>(std::size(kSurfaces)) + 3) {}

    Result<SynthesisReport> run() {
        auto path = resolve_course(real_, options_.path, 1.0);
        if (!path) return path.error();
        const platform::Pose start = path->frame(0);
        report_stores();
        RIDGELINE_TRY(walk(std::move(*path)));
        RIDGELINE_TRY(make_tiles(decimated_, jobs_, options_.making, report_.figures));
        step();
        RIDGELINE_TRY(compare_roughness());
        step();
        SynthesisPictureOptions pictures = options_.pictures;
        pictures.start = start;
        const auto drawn = draw_synthesis(real_, decimated_, kOctaves, jobs_, pictures);
        if (!drawn) return drawn.error();
        step();
        return std::move(report_);
    }

  private:
    void step() {
        if (options_.progress) options_.progress(++done_, total_);
    }

    void report_stores() {
        const auto report = [this](const char* name, const io::TerrainInfo& info) {
            report_.figures.set(name, "heights_bytes", static_cast<double>(info.heights_bytes));
            report_.figures.set(name, "mesh_bytes", static_cast<double>(info.mesh_bytes));
        };
        report("store/real", real_.info());
        report("store/decimated", decimated_.info());
    }

    Result<void> walk(platform::ResolvedPath path) {
        const BenchWalk walk{
            path_name(options_.path),      std::move(path), options_.frames, options_.pixel_error_px,
            {.size_px = options_.size_px}, options_.caches};
        const SynthesisBench bench{real_, decimated_, kOctaves, jobs_, walk, [this] { step(); }};
        report_.csv = synthesis_csv_header();
        for (const render::Surface surface : kSurfaces)
            RIDGELINE_TRY(walk_down(bench, surface, report_.figures, report_.csv));
        return {};
    }

    // Blocks of the real ground, wherever all of their samples are there.
    Result<void> compare_roughness() {
        constexpr int kSide = 48;
        select::SurfaceQuery real(real_), coarse(decimated_), made(decimated_, {.detail_levels = kOctaves});
        LostLags of_coarse, of_made;
        std::mt19937 random(3);
        const auto along = [&random](std::int64_t samples) {
            const std::int64_t room = std::max<std::int64_t>(samples - kSide - kStep, 1);
            return static_cast<int>(random() % static_cast<std::uint64_t>(room));
        };
        for (int i = 0; i < options_.blocks; ++i) {
            const int column = along(real_.info().width), row = along(real_.info().height);
            const auto there = block_of(real, {column, row}, kSide, 1);
            const auto interpolated = block_of(coarse, {column, row}, kSide, kStep);
            const auto synthesised = block_of(made, {column, row}, kSide, kStep);
            for (const auto* block : {&there, &interpolated, &synthesised})
                if (!*block) return block->error();
            if (there->empty() || interpolated->empty() || synthesised->empty()) continue;
            of_coarse.add(*there, *interpolated, kSide);
            of_made.add(*there, *synthesised, kSide);
        }
        for (int lag = 0; lag < LostLags::kLags; ++lag) {
            const std::string metric = "lag" + std::to_string(LostLags::samples(lag));
            report_.figures.set("roughness/decimated", metric, of_coarse.ratio(lag));
            report_.figures.set("roughness/made", metric, of_made.ratio(lag));
        }
        return {};
    }

    const io::Store& real_;
    const io::Store& decimated_;
    const SynthesisSuiteOptions& options_;
    jobs::JobSystem jobs_;
    SynthesisReport report_;
    std::int64_t done_ = 0, total_;
};

}  // namespace

Result<SynthesisReport> run_synthesis_suite(const io::Store& store, const SynthesisSuiteOptions& options) {
    const TemporaryFolder folder;
    const auto decimated = decimate(store, folder.path());
    if (!decimated) return decimated.error();
    return Suite(store, *decimated, options).run();
}

std::string synthesis_tables(const Figures& figures) {
    return figures.table("Down to the ground and along it (the paper's Fig. 7a)", "us_per_triangle",
                         {{"spacing_m", "spacing, m"},
                          {"fps_mean", "fps"},
                          {"fps_ratio", "/ real"},
                          {"frame_ms.p99", "p99 ms"},
                          {"per_frame.triangles", "K triangles", 1e3},
                          {"us_per_triangle", "us / triangle"},
                          {"us_per_triangle_ratio", "/ decimated"},
                          {"us_per_triangle_to_real", "/ real's"},
                          {"bytes_read", "MB read", 1e6},
                          {"bytes_uploaded", "MB uploaded", 1e6}}) +
           figures.table("Making", "tiles_made.max",
                         {{"tiles_made.mean", "tiles a frame"},
                          {"tiles_made.max", "most"},
                          {"make_ms.mean", "ms a frame"},
                          {"make_percent.all", "% of frames"},
                          {"make_percent.max", "% of a frame, most"}}) +
           figures.table("Tiles a second (the paper's Fig. 7b)", "tiles_per_s",
                         {{"tiles_per_s", "tiles / s"},
                          {"per_second_ratio", "/ cpu"},
                          {"bytes_sent_per_tile", "KB to send a tile", 1e3}}) +
           figures.table("Mean squared differences over the real ground's", "lag1",
                         {{"lag1", "lag 1"}, {"lag2", "lag 2"}, {"lag4", "lag 4"}});
}

}  // namespace ridgeline::app
