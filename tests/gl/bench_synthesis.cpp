// Suite `synthesis` on a small store: what it reports, that no frame makes more than its budget, and that pictures are
// written.
#include <doctest/doctest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "ridgeline/app/bench/synthesis_suite.h"
#include "ridgeline/app/walk/stage.h"
#include "ridgeline/base/json_text.h"
#include "support/gl_context.h"
#include "unit/build_fixture.h"

using namespace ridgeline;
using namespace ridgeline::test;

namespace {

constexpr std::int64_t kFrames = 8;

app::SynthesisSuiteOptions small_suite(const std::filesystem::path& folder) {
    app::SynthesisSuiteOptions options;
    options.frames = kFrames;
    options.size_px = {160, 120};
    options.caches.gpu_bytes = 64_MiB;
    options.making = {.parents = 2, .seconds = 0.02};
    options.blocks = 10;
    options.pictures.folder = folder;
    options.pictures.lens.size_px = {96, 64};
    return options;
}

io::Store hills(const ScratchFolder& folder, const Case& c) {
    MemoryRows rows = rows_of(c);
    REQUIRE(build::build_from_rows(rows, options_for(c, folder.path() / "hills.terrain")));
    auto store = io::Store::open(folder.path() / "hills.terrain");
    REQUIRE(store);
    return std::move(*store);
}

}  // namespace

TEST_CASE("synthesis suite: two surfaces over four grounds, tiles made twice, and how rough they are") {
    GlContext gl;
    if (!gl) return;
    const ScratchFolder folder;
    const io::Store store = hills(folder, {1025, 1025, 33, false, 4});
    app::SynthesisSuiteOptions options = small_suite(folder.path());
    std::int64_t last = 0, all = 0;
    options.progress = [&](std::int64_t done, std::int64_t total) {
        CHECK(done == last + 1);
        last = done;
        all = total;
    };
    const auto report = app::run_synthesis_suite(store, options);
    REQUIRE_MESSAGE(report, (report ? "" : report.error().message));
    CHECK(last == all);
    const auto json = parse_json(report->figures.to_json());
    const auto value = [&](const std::string& variant, const char* metric) {
        CAPTURE(variant);
        CAPTURE(metric);
        REQUIRE(json.at(variant).at(metric).is_number());
        return json.at(variant).at(metric).get<double>();
    };
    for (const std::string surface : {"disc/", "quadtree/"}) {
        for (const std::string ground : {"real", "decimated", "made", "deep"}) {
            CHECK(value(surface + ground, "fps_mean") > 0.0);
            CHECK(value(surface + ground, "us_per_triangle") > 0.0);
            CHECK(value(surface + ground, "bytes_uploaded") > 0.0);
        }
        CHECK(value(surface + "made", "spacing_m") == value(surface + "real", "spacing_m"));
        CHECK(value(surface + "deep", "spacing_m") < value(surface + "made", "spacing_m"));
        for (const std::string ground : {"made", "deep"}) {
            CHECK(value(surface + ground, "tiles_made.max") > 0.0);
            CHECK(value(surface + ground, "tiles_made.max") <= app::kMadeTilesPerFrame);
            CHECK(value(surface + ground, "us_per_triangle_ratio") > 0.0);
        }
    }
    CHECK(value("tiles/gpu", "tiles_per_s") > 0.0);
    CHECK(value("tiles/cpu", "per_second_ratio") == doctest::Approx(1.0));
    for (const char* lag : {"lag1", "lag2", "lag4"}) {
        CHECK(value("roughness/decimated", lag) > 0.0);
        CHECK(value("roughness/made", lag) > value("roughness/decimated", lag));
    }
    CHECK(std::ranges::count(report->csv, '\n') == 1 + 2 * kFrames);
    CHECK(std::filesystem::exists(folder.path() / "synthesis-4.png"));
    CHECK(app::synthesis_tables(report->figures).find("quadtree/deep") != std::string::npos);
}

TEST_CASE("synthesis suite: a terrain of which an eighth foretells nothing is refused") {
    GlContext gl;
    if (!gl) return;
    const ScratchFolder folder;
    const io::Store store = hills(folder, {257, 257, 33, false, 4});
    const auto report = app::run_synthesis_suite(store, small_suite(folder.path()));
    REQUIRE(!report);
    CHECK(report.error().message.find("too small") != std::string::npos);
}
