// Suite `stress` on a small store: what it reports, and that nothing breaks: no hole, no byte over budget,
// the picture of a sound disk once the faults have ended. And that it tells where something does.
#include <nlohmann/json.hpp>
#include <set>

#include "gl/render_scene.h"
#include "ridgeline/app/bench/stress_look.h"
#include "ridgeline/app/bench/stress_paths.h"
#include "ridgeline/app/bench/stress_suite.h"
#include "ridgeline/app/bench/stress_turn.h"
#include "ridgeline/app/walk/course.h"
#include "ridgeline/base/json_text.h"

using namespace ridgeline;
using namespace ridgeline::test;

namespace {

app::StressSuiteOptions small_suite() {
    app::StressSuiteOptions options;
    options.path = app::PathChoice{app::PathChoice::Kind::orbit, {}};
    options.frames = 8;
    options.turns = 1;
    options.size_px = {96, 72};
    options.pixel_error_px = 0.5;
    return options;
}

}  // namespace

TEST_CASE("stress suite: every variant keeps what must be kept, and says what it took") {
    GlContext gl;
    if (!gl) return;
    const SmallStore files(ReferenceTerrain(io::Grid(513, 513, 32), rugged_quanta));
    const auto store = io::Store::open(files.directory());
    const auto beside = io::Store::open(files.directory());
    REQUIRE(store);
    REQUIRE(beside);
    app::StressSuiteOptions options = small_suite();
    options.beside = &*beside;
    std::int64_t last = 0, all = 0;
    options.progress = [&](std::int64_t done, std::int64_t total) {
        CHECK(done == last + 1);
        last = done;
        all = total;
    };
    const auto figures = app::run_stress_suite(*store, options);
    REQUIRE_MESSAGE(figures, (figures ? "" : figures.error().message));
    CHECK(last == all);
    const auto verdict = app::stress_verdict(*figures);
    CHECK_MESSAGE(verdict, (verdict ? "" : verdict.error().message));
    const auto json = parse_json(figures->to_json());
    std::set<std::string> walked;
    for (const auto& [name, metrics] : json.items()) {
        if (!name.starts_with("orbit/")) continue;
        walked.insert(name);
        CAPTURE(name);
        for (const char* metric :
             {"frame_ms.p50", "frame_ms.p99", "frame_ms.p999", "frame_ms.max", "frame_ms.p99_ratio",
              "selection_ms.mean_ratio", "frames_with_missing_tiles", "request_to_ready_ms.p99",
              "eye_lift.frames", "tiles.failed", "failures.given_up"})
            CHECK_MESSAGE(metrics.contains(metric), metric);
        CHECK(metrics.at("background_pixels") == 0);
        CHECK(metrics.at("bytes_over_budget") == 0);
        CHECK(metrics.at("failures.left") == 0);
        const bool same_caches = name.find("cache_") == std::string::npos && !name.ends_with("beside");
        CHECK(metrics.contains("rest.differing_pixels") == same_caches);
        if (same_caches) CHECK(metrics.at("rest.differing_pixels") == 0);
    }
    CHECK(walked.size() == app::kStressVariants.size() + 1);
    // Faults were there to be survived.
    for (const char* faulty : {"orbit/errors", "orbit/short_reads", "orbit/corrupt", "orbit/slow_errors"})
        CHECK(json.at(faulty).at("failures.repeated") > 0);
    CHECK(json.at("orbit/clean").at("failures.repeated") == 0);
    for (const auto& variant : app::kStressVariants) {
        const auto& turn = json.at(std::string("turn/") + variant.name);
        CHECK(turn.at("turn_missing.max") == 0);
        CHECK(turn.at("turn_there_ms.mean") >= turn.at("turn_sharp_ms.mean"));
        CHECK(turn.at("turn_floor_ms.mean") > 0.0);
    }
    const std::string tables = app::stress_tables(*figures);
    for (const char* shown : {"orbit/all_faults", "turn/slow", "p99.9", "/ floor"})
        CHECK_MESSAGE(tables.find(shown) != std::string::npos, shown);
}

TEST_CASE("stress suite: a store beside that does not hold the ground is refused") {
    GlContext gl;
    if (!gl) return;
    const SmallStore files(ReferenceTerrain(io::Grid(257, 257, 32), rugged_quanta));
    const SmallStore smaller(ReferenceTerrain(io::Grid(129, 129, 32), rugged_quanta));
    const auto store = io::Store::open(files.directory());
    const auto beside = io::Store::open(smaller.directory());
    REQUIRE(store);
    REQUIRE(beside);
    app::StressSuiteOptions options = small_suite();
    options.beside = &*beside;
    const auto figures = app::run_stress_suite(*store, options);
    REQUIRE(!figures);
    CHECK(figures.error().message.find("--beside") != std::string::npos);
}

TEST_CASE("stress suite: walks the variants that are asked for") {
    GlContext gl;
    if (!gl) return;
    const SmallStore files(ReferenceTerrain(io::Grid(129, 129, 32), rugged_quanta));
    const auto store = io::Store::open(files.directory());
    REQUIRE(store);
    app::StressSuiteOptions options = small_suite();
    options.variants = {"corrupt", "clean"};
    const auto figures = app::run_stress_suite(*store, options);
    REQUIRE(figures);
    CHECK(figures->variants() == std::vector<std::string>{"orbit/clean", "orbit/corrupt", "disk/warm",
                                                          "turn/clean", "turn/corrupt"});
}

TEST_CASE("stress look: a hole in the ground and another picture are found") {
    const glm::ivec2 size(32, 24);
    gl::Image image{size, std::vector<std::byte>(std::size_t{3} * 32 * 24, std::byte{90})};
    const auto paint = [&](int x, int y) {
        const auto at = static_cast<std::size_t>(3 * (y * size.x + x));
        image.rgb[at] = image.rgb[at + 2] = std::byte{255};
        image.rgb[at + 1] = std::byte{0};
    };
    const gl::Image whole = image;
    app::StageMoment moment;
    moment.camera.lens.size_px = size;
    for (int x = 0; x < size.x; ++x)
        for (int y = 0; y < 6; ++y) paint(x, y);
    CHECK(app::wrong_background(image, moment, {}) == 0);
    CHECK(app::differing_pixels(image, whole) == 6 * size.x);
    CHECK(app::differing_pixels(image, image) == 0);
    paint(10, 14);
    paint(20, 16);
    CHECK(app::wrong_background(image, moment, {}) == 2);
}

TEST_CASE("stress verdict: whatever is not nothing is an error that names it") {
    app::Figures figures;
    figures.set("sprint/clean", "background_pixels", 0.0);
    figures.set("sprint/clean", "bytes_over_budget", 0.0);
    CHECK(app::stress_verdict(figures));
    for (const char* metric : {"background_pixels", "bytes_over_budget", "turn_unfinished.max",
                               "failures.left", "rest.differing_pixels"}) {
        app::Figures wrong = figures;
        wrong.set("sprint/slow", metric, 7.0);
        const auto verdict = app::stress_verdict(wrong);
        REQUIRE(!verdict);
        CHECK(verdict.error().message.starts_with("sprint/slow: 7 "));
    }
}
