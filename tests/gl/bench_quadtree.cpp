// Suite `quadtree` on a small store: what it reports, that both ways of choosing levels draw the same, and
// that more cells over the same tiles are more triangles.
#include <nlohmann/json.hpp>

#include "gl/render_scene.h"
#include "ridgeline/app/bench/quadtree_suite.h"
#include "ridgeline/base/json_text.h"
#include "ridgeline/render/quadtree_pass_clock.h"

using namespace ridgeline;
using namespace ridgeline::test;

namespace {

app::QuadtreeSuiteOptions small_suite() {
    app::QuadtreeSuiteOptions options;
    options.frames = 12;
    options.size_px = {160, 120};
    options.pixel_error_px = 0.5;
    return options;
}

}  // namespace

TEST_CASE("quadtree suite: every surface on one path, and cells in five numbers") {
    GlContext gl;
    if (!gl) return;
    const SmallStore files(ReferenceTerrain(io::Grid(513, 513, 32), rugged_quanta));
    const auto store = io::Store::open(files.directory());
    REQUIRE(store);
    app::QuadtreeSuiteOptions options = small_suite();
    std::int64_t last = 0, all = 0;
    options.progress = [&](std::int64_t done, std::int64_t total) {
        CHECK(done == last + 1);
        last = done;
        all = total;
    };
    const auto figures = app::run_quadtree_suite(*store, options);
    REQUIRE_MESSAGE(figures, (figures ? "" : figures.error().message));
    CHECK(last == all);
    const auto json = parse_json(figures->to_json());
    CHECK(json.size() == 4 + 2 * 5);
    const auto value = [&](const std::string& variant, const char* metric) {
        CAPTURE(variant);
        CAPTURE(metric);
        REQUIRE(json.at(variant).at(metric).is_number());
        return json.at(variant).at(metric).get<double>();
    };
    for (const std::string variant :
         {"ground/quadtree_gpu", "ground/quadtree_cpu", "ground/mesh", "ground/disc"}) {
        CHECK(value(variant, "fps_mean") > 0.0);
        CHECK(value(variant, "gpu_percent") > 0.0);
        CHECK(value(variant, "own_cpu_ms.render") > 0.0);
        // In a frame of its own it can be no more than all threads' time.
        CHECK(value(variant, "cpu_percent.own") <= value(variant, "cpu_percent.process"));
        CHECK(value(variant, "own_cpu_ms.mean") ==
              doctest::Approx(value(variant, "own_cpu_ms.render") + value(variant, "own_cpu_ms.workers")));
        CHECK(value(variant, "per_frame.triangles") > 0.0);
    }
    CHECK(value("ground/quadtree_cpu", "own_cpu_ratio") == doctest::Approx(1.0));
    CHECK(value("ground/mesh", "fps_ratio") == doctest::Approx(1.0));
    double passes_ms = 0.0;
    for (std::size_t i = 0; i < render::kQuadtreePasses; ++i)
        passes_ms += value("ground/quadtree_gpu",
                           (std::string("pass_ms.") + name_of(static_cast<render::QuadtreePass>(i))).c_str());
    CHECK(passes_ms > 0.0);
    CHECK(value("ground/quadtree_gpu", "pass_ms.all") == doctest::Approx(passes_ms));
    for (const std::string lod : {"still/gpu-", "still/cpu-"})
        CHECK(value(lod + "0.5", "triangles") > value(lod + "32", "triangles"));
    // Where all tiles are there, levels depend on nothing else.
    for (const std::string error : {"32", "8", "2", "1", "0.5"})
        CHECK(value("still/gpu-" + error, "triangles") == value("still/cpu-" + error, "triangles"));
    const std::string tables = app::quadtree_tables(*figures);
    CHECK(tables.find("ground/quadtree_cpu") != std::string::npos);
    CHECK(tables.find("still/gpu-0.5") != std::string::npos);
}
