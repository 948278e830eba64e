// Suite `horizon` on a small store: what it reports, and that culling is neither wrong nor in vain.
#include <nlohmann/json.hpp>

#include "gl/render_scene.h"
#include "ridgeline/app/bench/horizon_suite.h"
#include "ridgeline/base/json_text.h"

using namespace ridgeline;
using namespace ridgeline::test;

namespace {

const char* const kVariants[] = {"off", "boxes", "ridges"};

struct SmallGround {
    SmallGround() : files(ReferenceTerrain(io::Grid(257, 257, 32), rugged_quanta)) {
        auto opened = io::Store::open(files.directory());
        REQUIRE(opened);
        store = std::make_unique<io::Store>(std::move(*opened));
    }

    SmallStore files;
    std::unique_ptr<io::Store> store;
};

app::HorizonSuiteOptions small_suite() {
    app::HorizonSuiteOptions options;
    options.frames = 4;
    options.size_px = {160, 120};
    options.pixel_error_px = 20.0;
    options.dense_triangles = 3000.0;
    options.views = 12;
    return options;
}

}  // namespace

TEST_CASE(
    "horizon suite: every path and height by every variant, the metrics of a walk's summary among them") {
    GlContext gl;
    if (!gl) return;
    const SmallGround ground;
    app::HorizonSuiteOptions options = small_suite();
    std::int64_t last = 0, all = 0;
    options.progress = [&](std::int64_t done, std::int64_t total) {
        CHECK(done == last + 1);
        last = done;
        all = total;
    };
    const auto figures = app::run_horizon_suite(*ground.store, options);
    REQUIRE(figures);
    CHECK(last == all);
    const auto json = parse_json(figures->to_json());
    CHECK(json.size() == 3 * (3 + 4));
    for (const char* variant : kVariants) {
        for (const char* path : {"ground", "look", "dense"})
            for (const char* metric :
                 {"frame_ms.mean", "frame_ms.p99", "selection_ms.mean", "selection_ms.p99",
                  "per_frame.triangles", "per_frame.nodes_drawn", "per_frame.nodes_horizon_culled",
                  "per_frame.bytes_read", "tiles_in", "tiles_out", "bytes_read", "fps_mean", "fps_ratio",
                  "triangles_ratio", "tiles_ratio", "pixel_error_px"}) {
                CAPTURE(metric);
                CHECK(json.at(std::string(path) + "/" + variant).at(metric).is_number());
            }
        for (const char* height : {"2m", "30m", "200m", "1000m"})
            for (const char* metric : {"oracle_hidden_share", "wrongly_culled", "nodes_visible",
                                       "nodes_hidden", "per_frame.triangles", "per_frame.nodes_drawn",
                                       "triangles_ratio", "oracle_triangles_ratio", "selection_ms.mean"}) {
                CAPTURE(metric);
                CHECK(json.at(std::string(height) + "/" + variant).at(metric).is_number());
            }
    }
    CHECK(app::horizon_tables(*figures).find("dense/ridges") != std::string::npos);
}

TEST_CASE(
    "horizon suite: nothing seen is culled, ridges find most of what is hidden, none more than the oracle") {
    GlContext gl;
    if (!gl) return;
    const SmallGround ground;
    const auto figures = app::run_horizon_suite(*ground.store, small_suite());
    REQUIRE(figures);
    CHECK(app::wrongly_culled(*figures) == 0);
    const auto value = [&](const char* path, const char* variant, const char* metric) {
        return *figures->find(std::string(path) + "/" + variant, metric);
    };
    for (const char* path : {"2m", "30m"}) {
        CAPTURE(path);
        CHECK(value(path, "off", "oracle_hidden_share") == 0.0);
        CHECK(value(path, "ridges", "oracle_hidden_share") >= value(path, "boxes", "oracle_hidden_share"));
        for (const char* variant : kVariants) {
            CHECK(value(path, variant, "per_frame.nodes_drawn") >= value(path, variant, "nodes_visible"));
            CHECK(value(path, variant, "triangles_ratio") <= value(path, variant, "oracle_triangles_ratio"));
        }
    }
    CHECK(value("2m", "ridges", "oracle_hidden_share") > 0.5);
    CHECK(value("ground", "off", "per_frame.nodes_horizon_culled") == 0.0);
    CHECK(value("ground", "ridges", "per_frame.nodes_horizon_culled") > 0.0);
    CHECK(value("dense", "off", "pixel_error_px") < value("ground", "off", "pixel_error_px"));
}

TEST_CASE("horizon suite: caches are as large as asked for; tiles that do not fit leave and come again") {
    GlContext gl;
    if (!gl) return;
    const SmallGround ground;
    constexpr std::uint64_t kSmall = 1_MiB, kLarge = 64_MiB;
    const auto paged = [&](std::uint64_t ram_bytes) {
        app::HorizonSuiteOptions options = small_suite();
        options.pixel_error_px = 0.5;
        options.frames = 60;
        options.views = 1;
        options.caches = {.ram_bytes = ram_bytes, .gpu_bytes = 4_MiB};
        auto figures = app::run_horizon_suite(*ground.store, options);
        REQUIRE(figures);
        return std::move(*figures);
    };
    const app::Figures small = paged(kSmall), large = paged(kLarge);
    for (const char* path : {"ground/off", "look/off"}) {
        CHECK(*small.find(path, "ram_cache_bytes_max") <= static_cast<double>(kSmall));
        CHECK(*large.find(path, "ram_cache_bytes_max") > static_cast<double>(kSmall));
        CHECK(*large.find(path, "tiles_out") == 0.0);
        CHECK(*small.find(path, "gpu_cache_bytes_max") <= 2.0 * 1024.0 * 1024.0);
    }
    CHECK(*small.find("look/off", "tiles_out") > 0.0);
}
