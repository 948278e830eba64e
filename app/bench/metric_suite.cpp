#include "ridgeline/app/bench/metric_suite.h"

#include <array>
#include <cmath>
#include <optional>

#include "ridgeline/app/bench/skyline_views.h"
#include "ridgeline/app/bench/store_rows.h"
#include "ridgeline/app/bench/surface_errors.h"
#include "ridgeline/app/bench/temporary_folder.h"
#include "ridgeline/app/bench/view_triangles.h"
#include "ridgeline/build/builder.h"
#include "ridgeline/build/row_builder.h"
#include "ridgeline/select/criterion.h"

namespace ridgeline::app {
namespace {

constexpr std::uint32_t kSeed = 1;

struct Variant {
    const char* name;
    const io::Store& store;
};

// Which nodes the criterion draws all round an eye: neither balance nor morphs are looked at.
class DrawnNodes {
  public:
    DrawnNodes(const io::Store& store, double pixel_error_px) : store_(store) {
        select::View view;
        view.pixel_error_px = pixel_error_px;
        rule_ = (*select::make_criterion("screen_error", select::kErrorAlone))
                    ->rule(view, store.info(), store.grid());
    }

    template <class Visit>
    Result<void> for_each(const Eye& eye, Visit&& visit) const {
        const io::Grid& grid = store_.grid();
        for (std::int64_t i = 0; i < grid.first(1); ++i) RIDGELINE_TRY(descend(eye, grid.node_at(i), visit));
        return {};
    }

  private:
    template <class Visit>
    Result<void> descend(const Eye& eye, io::NodeId node, Visit&& visit) const {
        const io::NodeRecord& record = store_.record(node);
        if (!record.has_data()) return {};
        const io::Grid& grid = store_.grid();
        const bool splits = node.level < grid.finest() &&
                            distance_m(eye, node, record) < rule_.distance_m(record.error_m, node.level);
        if (!splits) return visit(node, record);
        for (int quarter = 0; quarter < io::kQuarters; ++quarter)
            if (const io::NodeId child = node.child(quarter); grid.contains(child))
                RIDGELINE_TRY(descend(eye, child, visit));
        return {};
    }

    double distance_m(const Eye& eye, io::NodeId node, const io::NodeRecord& record) const {
        const io::TerrainInfo& info = store_.info();
        const io::LatticePoint origin = store_.grid().origin(node);
        const auto extent = static_cast<double>(store_.grid().extent(node.level));
        const auto outside = [](double at, double least, double greatest) {
            return std::max({least - at, at - greatest, 0.0});
        };
        const auto x = static_cast<double>(origin.x), y = static_cast<double>(origin.y);
        return std::hypot(
            outside(eye.column, x, x + extent) * info.spacing_x_m,
            outside(eye.row, y, y + extent) * info.spacing_y_m,
            outside(eye.height_m, info.height_m(record.min_quanta), info.height_m(record.max_quanta)));
    }

    const io::Store& store_;
    select::SwitchingRule rule_;
};

// A view of 90 degrees sees a quarter of what lies all round, on average.
double mean_triangles(const io::Store& store, const std::vector<Eye>& eyes, double pixel_error_px) {
    const DrawnNodes nodes(store, pixel_error_px);
    double sum = 0.0;
    const auto add = [&sum](io::NodeId, const io::NodeRecord& record) -> Result<void> {
        sum += 0.25 * record.triangle_count;
        return {};
    };
    for (const Eye& eye : eyes) RIDGELINE_CHECK(nodes.for_each(eye, add).ok());
    return sum / static_cast<double>(std::max<std::size_t>(eyes.size(), 1));
}

double mean_error_m(const io::Store& store, int level) {
    const io::Grid& grid = store.grid();
    double sum = 0.0;
    for (std::int64_t i = grid.first(level); i < grid.first(level + 1); ++i)
        sum += static_cast<double>(store.records()[static_cast<std::size_t>(i)].error_m);
    return sum / static_cast<double>(grid.first(level + 1) - grid.first(level));
}

double level_triangles(const io::Store& store, int level) {
    const io::Grid& grid = store.grid();
    double sum = 0.0;
    for (std::int64_t i = grid.first(level); i < grid.first(level + 1); ++i)
        sum += store.records()[static_cast<std::size_t>(i)].triangle_count;
    return sum;
}

class Comparison {
  public:
    Comparison(const io::Store& geometric, const io::Store& cone, const MetricSuiteOptions& options)
        : options_(options),
          variants_{Variant{"geometric", geometric}, Variant{"cone", cone}},
          source_(geometric),
          total_(2 * geometric.grid().levels() + 3) {}

    Result<Figures> run() {
        RIDGELINE_TRY(source_.take_samples());
        eyes_ = random_eyes(info(), source_, options_.eyes, kSeed);
        const std::vector<platform::Pose> views = views_to_draw();
        total_ += static_cast<std::int64_t>(views.size());
        for (int level = 0; level < store(0).grid().levels(); ++level)
            for (const Variant& variant : variants_) RIDGELINE_TRY(compare_level(variant, level));
        RIDGELINE_TRY(compare_drawn());
        RIDGELINE_TRY(draw(views));
        return figures_;
    }

  private:
    const io::Store& store(std::size_t variant) const { return variants_[variant].store; }
    const io::TerrainInfo& info() const { return store(0).info(); }
    void step() {
        if (options_.progress) options_.progress(++done_, total_);
    }
    SkylineOptions skyline_options(double from_m) const {
        SkylineOptions skyline;
        skyline.columns = options_.columns;
        skyline.from_m = from_m;
        return skyline;
    }

    std::vector<platform::Pose> views_to_draw() const {
        if (!options_.pictures) return {};
        return choose_skyline_views(info(), source_, eyes_, {.lens = options_.pictures->lens});
    }

    Result<void> compare_level(const Variant& variant, int level);
    Result<void> compare_drawn();
    Result<void> compare_drawn(const std::string& name, const io::Store& store, double pixel_error_px);
    void set_skyline(const std::string& name, std::vector<double>& errors_px);
    Result<void> draw(const std::vector<platform::Pose>& views);

    const MetricSuiteOptions& options_;
    std::array<Variant, 2> variants_;
    SurfaceField source_;
    std::vector<Eye> eyes_;
    Figures figures_;
    std::int64_t done_ = 0, total_;
};

Result<void> Comparison::compare_level(const Variant& variant, int level) {
    SurfaceField surface(variant.store);
    RIDGELINE_TRY(surface.take_level(level));
    const std::string name = "level" + std::to_string(level) + "/" + variant.name;
    const GroundErrors ground = ground_errors(info(), source_, surface);
    figures_.set(name, "triangles", level_triangles(variant.store, level));
    figures_.set(name, "height_m.mean", ground.mean_m);
    figures_.set(name, "height_m.max", ground.worst_m);
    figures_.set(name, "normal_degrees.mean", ground.normal_degrees);
    SkylineOptions skyline = skyline_options(0.0);
    skyline.from_m = mean_error_m(store(0), level) * skyline.projection_px;
    std::vector<double> errors_px;
    for (const Eye& eye : eyes_) append_skyline_errors(info(), source_, surface, eye, skyline, errors_px);
    set_skyline(name, errors_px);
    step();
    return {};
}

Result<void> Comparison::compare_drawn() {
    const double triangles = mean_triangles(store(0), eyes_, options_.pixel_error_px);
    const double equal_px = pixel_error_for(triangles, {0.1, 10.0}, [this](double pixel_error_px) {
        return mean_triangles(store(1), eyes_, pixel_error_px);
    });
    for (const Variant& variant : variants_)
        RIDGELINE_TRY(
            compare_drawn(std::string("drawn/") + variant.name, variant.store, options_.pixel_error_px));
    return compare_drawn("drawn/cone_as_many_triangles", store(1), equal_px);
}

Result<void> Comparison::compare_drawn(const std::string& name, const io::Store& store,
                                       double pixel_error_px) {
    const DrawnNodes nodes(store, pixel_error_px);
    SurfaceField surface(store);
    std::vector<double> errors_px;
    for (const Eye& eye : eyes_) {
        RIDGELINE_TRY(nodes.for_each(
            eye, [&](io::NodeId node, const io::NodeRecord&) { return surface.take_mesh(node); }));
        append_skyline_errors(info(), source_, surface, eye, skyline_options(0.0), errors_px);
    }
    figures_.set(name, "triangles", mean_triangles(store, eyes_, pixel_error_px));
    figures_.set(name, "pixel_error_px", pixel_error_px);
    set_skyline(name, errors_px);
    step();
    return {};
}

void Comparison::set_skyline(const std::string& name, std::vector<double>& errors_px) {
    if (errors_px.empty()) return;
    const telemetry::Summary summary = telemetry::summarise(errors_px);
    figures_.set(name, "skyline_px.mean", summary.mean);
    figures_.set(name, "skyline_px.p99", summary.p99);
}

Result<void> Comparison::draw(const std::vector<platform::Pose>& views) {
    if (views.empty()) return {};
    MetricPictures pictures(store(0), store(1), *options_.pictures);
    for (std::size_t i = 0; i < views.size(); ++i) {
        RIDGELINE_TRY(pictures.draw(views[i], "metric-" + std::to_string(i + 1), figures_));
        step();
    }
    return {};
}

Result<io::Store> build_store(const io::Store& from, const std::vector<std::string>& sources,
                              build::Metric metric, const std::filesystem::path& folder) {
    build::BuildOptions options;
    options.sources = sources;
    options.metric = metric;
    options.tile = from.info().tile;
    options.out = folder / (std::string(build::metric_name(metric)) + ".terrain");
    StoreRows rows(from);
    const auto built =
        sources.empty() ? build::build_from_rows(rows, options) : build::build_terrain(options);
    if (!built) return built.error();
    return io::Store::open(options.out);
}

}  // namespace

Result<Figures> compare_metrics(const io::Store& geometric, const io::Store& cone,
                                const MetricSuiteOptions& options) {
    return Comparison(geometric, cone, options).run();
}

Result<Figures> run_metric_suite(const MetricSuiteInputs& inputs, const MetricSuiteOptions& options) {
    const auto given = io::Store::open(inputs.directory);
    if (!given) return given.error();
    const TemporaryFolder folder;
    const auto geometric = build_store(*given, inputs.sources, build::Metric::geometric, folder.path());
    if (!geometric) return geometric.error();
    const auto cone = build_store(*given, inputs.sources, build::Metric::cone, folder.path());
    if (!cone) return cone.error();
    return compare_metrics(*geometric, *cone, options);
}

}  // namespace ridgeline::app
