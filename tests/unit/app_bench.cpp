// The bench's measures: surfaces against the slow exact reference, errors that are known, what a suite
// reports.
#include <doctest/doctest.h>

#include <cmath>
#include <list>
#include <nlohmann/json.hpp>

#include "build_fixture.h"
#include "ridgeline/app/bench/decimated_rows.h"
#include "ridgeline/app/bench/descent.h"
#include "ridgeline/app/bench/figures.h"
#include "ridgeline/app/bench/lost_lags.h"
#include "ridgeline/app/bench/metric_suite.h"
#include "ridgeline/app/bench/store_rows.h"
#include "ridgeline/app/bench/surface_errors.h"
#include "ridgeline/app/bench/surface_field.h"
#include "ridgeline/base/json_text.h"

using namespace ridgeline;
using namespace ridgeline::app;
using namespace ridgeline::test;

namespace {

struct Built {
    explicit Built(const Case& c) : rows(rows_of(c)) { build("t.terrain", rows, c); }
    io::Store& build(const std::string& name, build::HeightRows& from, const Case& c) {
        REQUIRE(build::build_from_rows(from, options_for(c, folder.path() / name)));
        auto opened = io::Store::open(folder.path() / name);
        REQUIRE(opened);
        stores.push_back(std::move(*opened));
        return stores.back();
    }
    const io::Store& store() const { return stores.front(); }

    ScratchFolder folder;
    MemoryRows rows;
    std::list<io::Store> stores;
};

const std::vector<Case> kGrounds = {{300, 200, 33, true, 5}, {513, 513, 33, false, 4}};

}  // namespace

TEST_CASE("surface field: every level's surface at every sample, and the samples where they are valid") {
    for (const Case& c : kGrounds) {
        const Built built(c);
        const ReferenceTerrain terrain = reference_of(built.store(), built.rows);
        const io::TerrainInfo& info = built.store().info();
        SurfaceField field(built.store());
        REQUIRE(field.take_samples());
        std::int64_t wrong = 0;
        for (std::int64_t y = 0; y < c.height; ++y)
            for (std::int64_t x = 0; x < c.width; ++x)
                wrong += built.rows.valid(x, y)
                             ? double{field.at(x, y)} != info.height_m(built.rows.sample(x, y))
                             : !std::isnan(field.at(x, y));
        CHECK(wrong == 0);
        for (int level = 0; level < built.store().grid().levels(); ++level) {
            REQUIRE(field.take_level(level));
            // Fans hold their vertices to the quantum, which can bend a border by half of one.
            for (std::int64_t y = 0; y < c.height; ++y)
                for (std::int64_t x = 0; x < c.width; ++x)
                    if (built.rows.valid(x, y))
                        wrong +=
                            std::abs(double{field.at(x, y)} - info.height_m(terrain.surface(level, x, y))) >
                            0.51 * info.quantum_m;
            CHECK(wrong == 0);
        }
    }
}

TEST_CASE("ground errors: of a surface that is the source none, of a tilted one its height and angle") {
    const Case flat{100, 80, 33, false, 1};
    MemoryRows level(flat.width, flat.height, [](std::int64_t, std::int64_t) { return 40; });
    MemoryRows tilted(flat.width, flat.height,
                      [](std::int64_t x, std::int64_t) { return static_cast<std::int32_t>(40 + 2 * x); });
    Built built(flat);
    const io::Store& a = built.build("a.terrain", level, flat);
    const io::Store& b = built.build("b.terrain", tilted, flat);
    SurfaceField source(a), same(a), other(b);
    REQUIRE(source.take_samples());
    REQUIRE(same.take_level(0));
    REQUIRE(other.take_level(a.grid().finest()));
    const GroundErrors none = ground_errors(a.info(), source, same);
    CHECK(none.worst_m == 0.0);
    CHECK(none.normal_degrees == 0.0);
    // Two quanta of half a metre a sample, six metres apart.
    const GroundErrors some = ground_errors(a.info(), source, other);
    CHECK(some.worst_m == doctest::Approx(99.0));
    CHECK(some.mean_m == doctest::Approx(49.5));
    CHECK(some.normal_degrees == doctest::Approx(std::atan(1.0 / 6.0) * 180.0 / 3.14159265).epsilon(1e-4));
}

TEST_CASE("skyline errors: a wall that a surface lacks is missed by its slope, in pixels, where it is seen") {
    const Case flat{200, 200, 33, false, 1};
    const auto wall = [](std::int64_t x, std::int64_t) { return x == 150 ? 200 : 0; };
    MemoryRows with(flat.width, flat.height, wall);
    MemoryRows without(flat.width, flat.height, [](std::int64_t, std::int64_t) { return 0; });
    Built built(flat);
    SurfaceField source(built.build("with.terrain", with, flat));
    SurfaceField surface(built.build("without.terrain", without, flat));
    REQUIRE(source.take_samples());
    REQUIRE(surface.take_samples());
    const io::TerrainInfo& info = built.stores.back().info();
    // Ten metres above the ground, 300 m west of a wall 100 m high.
    const Eye eye{100.0, 100.0, info.height_offset_m + 10.0};
    SkylineOptions options;
    options.columns = 4 * 90;
    std::vector<double> errors_px;
    append_skyline_errors(info, source, surface, eye, options, errors_px);
    REQUIRE(errors_px.size() == 360);
    // Straight at the wall; without it, the skyline is the end of the ground, 594 m away.
    const double expected = (90.0 / 300.0 + 10.0 / 594.0) * options.projection_px;
    CHECK(errors_px[89] == doctest::Approx(expected).epsilon(0.03));
    CHECK(errors_px[270] == 0.0);
    errors_px.clear();
    options.from_m = 400.0;
    append_skyline_errors(info, source, surface, eye, options, errors_px);
    CHECK(*std::max_element(errors_px.begin(), errors_px.end()) < expected);
    errors_px.clear();
    append_skyline_errors(info, source, source, eye, options, errors_px);
    CHECK(*std::max_element(errors_px.begin(), errors_px.end()) == 0.0);
}

TEST_CASE("store rows: a store built from a store's heights has the same tiles") {
    for (const Case& c : kGrounds) {
        Built built(c);
        StoreRows rows(built.store());
        built.build("again.terrain", rows, c);
        const auto first = file_contents(built.folder.path() / "t.terrain");
        const auto again = file_contents(built.folder.path() / "again.terrain");
        for (const char* file : {"nodes.bin", "heights.tiles", "mesh.tiles"})
            CHECK(first.at(file) == again.at(file));
    }
}

TEST_CASE("decimated rows: every so manieth sample keeps its place, its height, and whether it has one") {
    for (const Case& c : kGrounds) {
        Built built(c);
        DecimatedRows rows(built.store(), 4);
        const io::TerrainInfo &from = built.store().info(), &info = rows.info();
        CHECK(info.width == (from.width - 1) / 4 + 1);
        std::vector<std::int32_t> quanta(static_cast<std::size_t>(2 * info.width));
        std::int64_t wrong = 0;
        for (std::int64_t row = 0; row + 1 < info.height; row += 2) {
            REQUIRE(rows.read(row, 2, quanta));
            for (std::int64_t i = 0; i < 2 * info.width; ++i) {
                const std::int64_t x = 4 * (i % info.width), y = 4 * (row + i / info.width);
                const std::int32_t expected =
                    built.rows.valid(x, y) ? built.rows.sample(x, y) : build::kNoHeight;
                wrong += quanta[static_cast<std::size_t>(i)] != expected ? 1 : 0;
            }
        }
        CHECK(wrong == 0);
        CHECK(info.world(7.0, 5.0) == from.world(28.0, 20.0));
    }
}

TEST_CASE(
    "descent: from 5 km to half a metre over one place, then on at 50 m/s, and no farther than the path") {
    std::vector<platform::Pose> poses;
    for (int i = 0; i < 100; ++i) poses.push_back({{3.0 * i, 4.0 * i, 0.0}, Angle::from_degrees(i), {}});
    const Descent descent(platform::ResolvedPath(poses, platform::Seconds(1.0), platform::PathEnd::hold));
    CHECK(descent.at(0.0).pose.eye_m.z == doctest::Approx(5000.0));
    CHECK(descent.at(0.5).pose.eye_m.z == doctest::Approx(0.5));
    CHECK(descent.at(0.75).pose.eye_m.z == doctest::Approx(0.5));
    CHECK(glm::length(glm::dvec2(descent.at(0.3).pose.eye_m)) == 0.0);
    // Half a second of 20, so 25 m of the path.
    CHECK(glm::length(glm::dvec2(descent.at(0.525).pose.eye_m)) == doctest::Approx(25.0));
    CHECK(descent.at(0.525).pose.heading.degrees() == doctest::Approx(5.0));
    CHECK(glm::dvec2(descent.at(1.0).pose.eye_m) == glm::dvec2(poses.back().eye_m));
}

TEST_CASE("lost lags: twice as high a ground has four times the squared differences, at every lag") {
    std::vector<double> real_m, made_m;
    for (int i = 0; i < 64; ++i) {
        real_m.push_back(i * i % 17);
        made_m.push_back(2.0 * real_m.back());
    }
    LostLags lags;
    CHECK(lags.ratio(0) == 0.0);
    lags.add(real_m, made_m, 8);
    for (int lag = 0; lag < LostLags::kLags; ++lag) CHECK(lags.ratio(lag) == doctest::Approx(4.0));
}

TEST_CASE("figures: JSON by variant and metric, in order; a table with blanks for what is missing") {
    Figures figures;
    figures.set("ground/ridges", "triangles", 12.0);
    figures.set("ground/off", "triangles", 20000.0);
    figures.set("ground/off", "frame_ms.p99", 0.125);
    figures.set("ground/ridges", "triangles", 13.0);
    CHECK(parse_json(figures.to_json()) ==
          nlohmann::json{{"ground/ridges", {{"triangles", 13.0}}},
                         {"ground/off", {{"triangles", 20000.0}, {"frame_ms.p99", 0.125}}}});
    CHECK(figures.to_table() ==
          "               triangles  frame_ms.p99\n"
          "ground/ridges         13              \n"
          "ground/off         20000         0.125\n");
    CHECK(figures.find("ground/ridges", "frame_ms.p99") == nullptr);
}

TEST_CASE("metric suite: reports every level and what is drawn; a store beside itself is no different") {
    const Built built({513, 513, 33, false, 4});
    MetricSuiteOptions options;
    options.eyes = 6;
    options.columns = 32;
    std::int64_t last = 0, all = 0;
    options.progress = [&](std::int64_t done, std::int64_t total) {
        CHECK(done == last + 1);
        last = done;
        all = total;
    };
    const auto figures = compare_metrics(built.store(), built.store(), options);
    REQUIRE(figures);
    CHECK(last == all);
    for (int level = 0; level < built.store().grid().levels(); ++level) {
        const std::string name = "level" + std::to_string(level);
        for (const char* metric : {"triangles", "height_m.mean", "height_m.max", "normal_degrees.mean"}) {
            const double* geometric = figures->find(name + "/geometric", metric);
            const double* cone = figures->find(name + "/cone", metric);
            REQUIRE(geometric != nullptr);
            REQUIRE(cone != nullptr);
            CHECK(*geometric == *cone);
        }
        // The stored error bounds what the suite measures.
        double bound_m = 0.0;
        for (std::int64_t i = built.store().grid().first(level); i < built.store().grid().first(level + 1);
             ++i)
            bound_m = std::max(bound_m, double{built.store().records()[static_cast<std::size_t>(i)].error_m});
        CHECK(*figures->find(name + "/cone", "height_m.max") <=
              bound_m + 0.5 * built.store().info().quantum_m);
    }
    for (const char* metric : {"triangles", "skyline_px.mean", "skyline_px.p99"}) {
        REQUIRE(figures->find("drawn/cone", metric) != nullptr);
        CHECK(*figures->find("drawn/cone", metric) == *figures->find("drawn/geometric", metric));
    }
    CHECK(*figures->find("drawn/cone_as_many_triangles", "triangles") ==
          doctest::Approx(*figures->find("drawn/cone", "triangles")).epsilon(0.05));
}
