// How long a selection takes: random views near the ground and above it, over a store given as argument, or
// over made-up records of 8193^2 and 32769^2 samples. Over a store, also with the horizon. Prints tables;
// docs/selection.md says what they were where.
//
//   bench_select [DIR.terrain]
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <deque>
#include <random>
#include <string>
#include <vector>

#include "ridgeline/io/chunk_codec.h"
#include "ridgeline/io/store.h"
#include "ridgeline/jobs/job_system.h"
#include "ridgeline/select/drawn_surface.h"
#include "ridgeline/select/seen_ground.h"
#include "ridgeline/select/selection.h"
#include "ridgeline/select/surface_query.h"
#include "ridgeline/select/tile_schedule.h"

namespace {

using namespace ridgeline;
using Random = std::mt19937_64;

double uniform(Random& random, double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
}

struct Terrain {
    io::TerrainInfo info;
    std::vector<io::NodeRecord> records;
};

// Errors as mountains at 20 m have them: about 14 m at the finest level but one, doubling upwards, uneven.
Terrain made_up(std::int64_t samples) {
    Terrain terrain;
    terrain.info.width = terrain.info.height = samples;
    terrain.info.spacing_x_m = terrain.info.spacing_y_m = 20.0;
    terrain.info.max_height_m = 4000.0;
    const io::Grid grid = terrain.info.grid();
    terrain.records.resize(static_cast<std::size_t>(grid.node_count()));
    Random random(1);
    for (std::int64_t i = grid.node_count() - 1; i >= 0; --i) {
        const io::NodeId node = grid.node_at(i);
        io::NodeRecord& record = terrain.records[static_cast<std::size_t>(i)];
        const double height = 1500.0 + 1200.0 * std::sin(node.x * 3.0 / grid.nodes_x(node.level)) +
                              uniform(random, -200.0, 200.0);
        record.flags = io::NodeRecord::kHasData;
        record.min_quanta = static_cast<std::int32_t>(height - 100.0);
        record.max_quanta = static_cast<std::int32_t>(height + 100.0);
        record.triangle_count = 4000;
        record.error_m =
            static_cast<float>(uniform(random, 2.0, 14.0) * std::exp2(grid.finest() - 1 - node.level));
        for (int q = 0; q < io::kQuarters && node.level < grid.finest(); ++q) {
            const io::NodeRecord& child =
                terrain.records[static_cast<std::size_t>(grid.linear(node.child(q)))];
            record.error_m = std::max(record.error_m, child.error_m);
            record.min_quanta = std::min(record.min_quanta, child.min_quanta);
            record.max_quanta = std::max(record.max_quanta, child.max_quanta);
        }
    }
    return terrain;
}

// Over the top of the finest node at a place.
double top_m(const io::TerrainInfo& info, std::span<const io::NodeRecord> records, double column,
             double row) {
    const io::Grid grid = info.grid();
    const auto node = select::node_at_place(grid, grid.finest(), column, row);
    return info.height_m(records[static_cast<std::size_t>(grid.linear(node))].max_quanta);
}

// Places within the square that is `inner` samples a side at the north-western corner. pitch: 0 level, else
// down.
select::View random_view(const io::TerrainInfo& info, std::span<const io::NodeRecord> records,
                         std::int64_t inner, double above_m, Angle pitch, Random& random) {
    select::Camera camera;
    const double side = static_cast<double>(std::min({inner, info.width, info.height}) - 1);
    const double column = uniform(random, 0.1, 0.9) * side, row = uniform(random, 0.1, 0.9) * side;
    camera.eye_m = {info.world(column, row), top_m(info, records, column, row) + above_m};
    const double heading = uniform(random, 0.0, 6.3);
    const double level = std::cos(pitch.radians()), down = std::sin(pitch.radians());
    camera.forward = {std::sin(heading) * level, std::cos(heading) * level, -down};
    camera.right = {std::cos(heading), -std::sin(heading), 0.0};
    camera.up = glm::cross(camera.right, camera.forward);
    camera.speed_m_per_s = 30.0;
    camera.turn_per_second = Angle::from_degrees(30.0);
    return select::make_view(camera, {});
}

struct Kind {
    const char* name;
    double above_m;
    Angle pitch;
};
constexpr Kind kKinds[] = {{"2 m, level", 2.0, Angle::from_degrees(0.0)},
                           {"200 m, level", 200.0, Angle::from_degrees(5.0)},
                           {"2000 m, down", 2000.0, Angle::from_degrees(65.0)}};

void measure_views(const char* name, const Kind& kind, select::Selection& selection,
                   const io::TerrainInfo& info, std::span<const io::NodeRecord> records, std::int64_t inner,
                   select::Residency residency) {
    constexpr int kWarmUp = 100, kViews = 2000;
    Random random(7);
    std::vector<double> micros;
    double visited = 0.0, drawn = 0.0, wanted = 0.0;
    for (int i = 0; i < kWarmUp + kViews; ++i) {
        const auto view = random_view(info, records, inner, kind.above_m, kind.pitch, random);
        const auto from = std::chrono::steady_clock::now();
        const auto& counters = selection.run(view, residency).counters;
        const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - from;
        if (i < kWarmUp) continue;
        micros.push_back(took.count());
        visited += counters.visited, drawn += counters.drawn, wanted += counters.wanted;
    }
    std::sort(micros.begin(), micros.end());
    std::printf("%-8s %-13s %7.0f %7.0f %9.0f %7.0f %7.0f\n", name, kind.name, micros[kViews / 2],
                micros[kViews * 9 / 10], visited / kViews, drawn / kViews, wanted / kViews);
}

void measure(const char* name, const io::TerrainInfo& info, std::span<const io::NodeRecord> records,
             std::int64_t inner) {
    std::vector<io::NodeResidency> residency(records.size());
    for (std::size_t i = 0; i < records.size(); ++i) residency[i].resident = records[i].has_data();
    for (const char* criterion_name : {"screen_error", "distance"}) {
        std::printf("%s\n%-8s %-13s %7s %7s %9s %7s %7s\n", criterion_name, "terrain", "view", "us p50",
                    "us p90", "visited", "drawn", "wanted");
        const auto criterion = select::make_criterion(criterion_name).value();
        select::Selection selection(info, records, *criterion);
        for (const Kind& kind : kKinds) measure_views(name, kind, selection, info, records, inner, residency);
    }
}

// Decodes chunks as they are first asked for, and keeps them until it is told to forget. As quick to ask as
// the pager.
class StoreGround final : public select::GroundSource {
  public:
    explicit StoreGround(const io::Store& store) : store_(store), views_(store.records().size()) {}

    io::ChunkView chunk(std::uint32_t index) const override {
        io::ChunkView& view = views_[index];
        if (!view) decode(index, view);
        return view;
    }
    void forget() {
        views_.assign(views_.size(), {});
        blocks_.clear();
    }

  private:
    void decode(std::uint32_t index, io::ChunkView& view) const {
        const io::NodeRecord& record = store_.records()[index];
        const io::NodeId node = store_.grid().node_at(index);
        const std::size_t bytes = io::chunk_layout(record, store_.chunk_shape()).total;
        blocks_.emplace_back(bytes / sizeof(io::ChunkVertex) + 1);
        view = {std::as_writable_bytes(std::span(blocks_.back())), record, store_.chunk_shape()};
        const bool good = store_.read_heights(node, bytes_, heights_) &&
                          store_.read_payload(io::Layer::mesh, node, bytes_) &&
                          io::decode_chunk(store_.grid(), node, record, store_.chunk_spacing(), bytes_,
                                           heights_, scratch_, view);
        if (!good) std::fprintf(stderr, "a chunk is damaged\n"), std::exit(1);
    }

    const io::Store& store_;
    mutable std::vector<io::ChunkView> views_;  // by node
    mutable std::deque<std::vector<io::ChunkVertex>> blocks_;
    mutable std::vector<std::uint8_t> bytes_;
    mutable io::HeightsTile heights_;
    mutable io::ChunkScratch scratch_;
};

double median(std::vector<double>& values) {
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                     values.end());
    return values[values.size() / 2];
}

// Level views from so many metres over the ground; the same for every mode.
void measure_horizon(const io::Store& store, double above_m, jobs::JobSystem* jobs) {
    constexpr int kViews = 100, kRuns = 5;
    struct Mode {
        const char* name;
        select::HorizonMode mode;
        std::vector<double> micros{};
        double drawn = 0.0, culled = 0.0, triangles = 0.0, wanted = 0.0;
    };
    Mode modes[] = {{"off", select::HorizonMode::off},
                    {"boxes", select::HorizonMode::boxes},
                    {"ridges", select::HorizonMode::ridges}};
    const auto criterion = select::make_criterion("screen_error").value();
    select::Selection selection(store.info(), store.records(), *criterion, {.jobs = jobs});
    // Decodes chunks, on one thread.
    select::Selection first(store.info(), store.records(), *criterion);
    std::vector<io::NodeResidency> residency(store.records().size());
    for (std::size_t i = 0; i < residency.size(); ++i) residency[i].resident = store.records()[i].has_data();
    select::SurfaceQuery surface(store);
    StoreGround ground(store);
    Random random(11);
    for (int i = 0; i < kViews;) {
        select::View view = random_view(store.info(), store.records(), 1 << 30, 0.0, Angle(), random);
        const glm::dvec2 place = store.info().lattice(view.eye_m.x, view.eye_m.y);
        const auto height = surface.height_at(place.x, place.y);
        if (!height || height->kind != select::SurfaceHeight::Kind::ground || height->height_m < 100.0)
            continue;
        ++i;
        const double down_m = height->height_m + above_m - view.eye_m.z;
        view.eye_m.z += down_m;
        for (auto& plane : view.visible.planes) plane.offset -= plane.normal.z * down_m;
        for (Mode& mode : modes) {
            view.horizon = mode.mode;
            first.run(view, residency, &ground);
            double best = 1e9;
            for (int run = 0; run < kRuns; ++run) {
                const auto from = std::chrono::steady_clock::now();
                selection.run(view, residency, &ground);
                const std::chrono::duration<double, std::micro> took =
                    std::chrono::steady_clock::now() - from;
                best = std::min(best, took.count());
            }
            const auto& counters = selection.result().counters;
            mode.micros.push_back(best);
            mode.drawn += counters.drawn, mode.culled += counters.horizon_culled;
            mode.triangles += static_cast<double>(counters.triangles), mode.wanted += counters.wanted;
        }
        ground.forget();
    }
    for (Mode& mode : modes)
        std::printf("%5.0f m  %-7s %7.0f us  drawn %6.1f  hidden %5.1f %%  triangles %9.0f  wanted %6.0f\n",
                    above_m, mode.name, median(mode.micros), mode.drawn / kViews,
                    100.0 * mode.culled / (mode.culled + mode.drawn), mode.triangles / kViews,
                    mode.wanted / kViews);
}

// Imagery of 1.25 m over the whole terrain, in 512 slots, scheduled over what the selection draws.
void measure_schedule(const char* name, const Terrain& terrain) {
    constexpr int kWarmUp = 100, kViews = 1000;
    constexpr double kTexel_m = 1.25;
    const io::TerrainInfo& info = terrain.info;
    const auto texels = static_cast<std::int64_t>((info.max_east_m() - info.min_east_m()) / kTexel_m);
    const select::GroundBounds bounds(info, terrain.records);
    select::SeenGround seen(info, bounds.terrain());
    select::TileTree tree{.grid = io::Grid(texels + 1, texels + 1, 128),
                          .west_m = info.min_east_m(),
                          .north_m = info.max_north_m(),
                          .spacing_x_m = kTexel_m,
                          .spacing_y_m = kTexel_m,
                          .present = {}};
    select::TileSchedule schedule(tree, bounds, 512);
    std::vector<io::NodeResidency> residency(terrain.records.size());
    for (auto& node : residency) node.resident = true;
    const auto criterion = select::make_criterion("screen_error").value();
    select::Selection selection(info, terrain.records, *criterion);
    std::printf("schedule\n%-8s %-13s %7s %7s %7s %7s %7s %7s\n", "terrain", "view", "seen us", "us p50",
                "us p90", "passing", "merges", "tiles");
    for (const Kind& kind : kKinds) {
        Random random(7);
        std::vector<double> micros, seen_micros;
        double passing = 0.0, merges = 0.0, tiles = 0.0;
        for (int i = 0; i < kWarmUp + kViews; ++i) {
            const auto view = random_view(info, terrain.records, 8193, kind.above_m, kind.pitch, random);
            const auto& selected = selection.run(view, residency);
            const auto from = std::chrono::steady_clock::now();
            const auto ground = seen.see(view, {.eye_m = view.eye_m}, selected, nullptr);
            const auto between = std::chrono::steady_clock::now();
            const auto& result = schedule.run(ground);
            const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - between;
            const std::chrono::duration<double, std::micro> seeing = between - from;
            if (i < kWarmUp) continue;
            micros.push_back(took.count()), seen_micros.push_back(seeing.count());
            passing += result.counters.passing, merges += result.counters.merges;
            tiles += static_cast<double>(result.tiles.size());
        }
        std::sort(micros.begin(), micros.end());
        std::printf("%-8s %-13s %7.0f %7.0f %7.0f %7.0f %7.0f %7.0f\n", name, kind.name, median(seen_micros),
                    micros[kViews / 2], micros[kViews * 9 / 10], passing / kViews, merges / kViews,
                    tiles / kViews);
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc == 2) {
        const auto store = io::Store::open(argv[1]);
        if (!store) return std::fprintf(stderr, "%s\n", store.error().message.c_str()), 1;
        for (const double above_m : {2.0, 30.0, 200.0}) measure_horizon(*store, above_m, nullptr);
        std::printf("two workers\n");
        jobs::JobSystem jobs({.workers = 2});
        for (const double above_m : {2.0, 30.0, 200.0}) measure_horizon(*store, above_m, &jobs);
        measure("store", store->info(), store->records(), 1 << 30);
        return 0;
    }
    for (const std::int64_t samples : {8193, 32769}) {
        const Terrain terrain = made_up(samples);
        measure(std::to_string(samples).c_str(), terrain.info, terrain.records, 8193);
        measure_schedule(std::to_string(samples).c_str(), terrain);
    }
    return 0;
}
