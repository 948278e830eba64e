// Suite `scheduling` on a small store with imagery: what it reports, that its sums are those of its curves,
// and that a store without imagery is refused.
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "gl/render_scene.h"
#include "ridgeline/app/bench/cpu_lod.h"
#include "ridgeline/app/bench/scheduling_clipmaps.h"
#include "ridgeline/app/bench/scheduling_suite.h"
#include "ridgeline/base/json_text.h"
#include "support/small_imagery.h"

using namespace ridgeline;
using namespace ridgeline::test;

namespace {

const char* const kDrawn[] = {"ridges", "off", "disc", "cpu_lod"};
const char* const kReckoned[] = {"clipmap", "clipmap_rgb8", "clipmap_lean", "clipmap_disc"};

enum class Layers { heights, imagery };

struct SmallGround {
    explicit SmallGround(Layers layers) : files(ReferenceTerrain(io::Grid(257, 257, 32), rugged_quanta)) {
        if (layers == Layers::imagery) {
            const auto info = io::read_terrain_info(files.directory());
            REQUIRE(info);
            MemoryTexels texels(frame_over(*info, 5), [](std::int64_t x, std::int64_t y) {
                return build::Texel{static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y), 90,
                                    build::kOpaque};
            });
            add_imagery(files.directory(), texels);
        }
        auto opened = io::Store::open(files.directory());
        REQUIRE(opened);
        store = std::make_unique<io::Store>(std::move(*opened));
    }

    SmallStore files;
    std::unique_ptr<io::Store> store;
};

app::SchedulingSuiteOptions small_suite() {
    app::SchedulingSuiteOptions options;
    options.frames = 12;
    options.size_px = {160, 120};
    options.pixel_error_px = 2.0;
    return options;
}

// By column, the numbers of one path.
std::map<std::string, std::vector<double>> columns_of(const std::string& csv, const std::string& path) {
    std::istringstream lines(csv);
    std::string line, cell;
    const auto cells_of = [&] {
        std::vector<std::string> cells;
        std::istringstream text(line);
        while (std::getline(text, cell, ',')) cells.push_back(cell);
        return cells;
    };
    REQUIRE(std::getline(lines, line));
    const auto names = cells_of();
    std::map<std::string, std::vector<double>> columns;
    while (std::getline(lines, line)) {
        const auto cells = cells_of();
        REQUIRE(cells.size() == names.size());
        if (cells[0] != path) continue;
        for (std::size_t i = 1; i < cells.size(); ++i) columns[names[i]].push_back(std::stod(cells[i]));
    }
    return columns;
}

double mean(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
}

}  // namespace

TEST_CASE("scheduling suite: every path by every variant, a curve for each, whose means are the figures") {
    GlContext gl;
    if (!gl) return;
    const SmallGround ground(Layers::imagery);
    app::SchedulingSuiteOptions options = small_suite();
    std::int64_t last = 0, all = 0;
    options.progress = [&](std::int64_t done, std::int64_t total) {
        CHECK(done == last + 1);
        last = done;
        all = total;
    };
    const auto report = app::run_scheduling_suite(*ground.store, options);
    REQUIRE(report);
    CHECK(last == all);
    const auto json = parse_json(report->figures.to_json());
    CHECK(json.size() == 2 * 8);
    for (const char* path : {"ground", "orbit"}) {
        const auto columns = columns_of(report->csv, path);
        const auto metrics = [&](const char* variant, std::initializer_list<const char*> names) {
            for (const char* metric : names) {
                CAPTURE(metric);
                CHECK(json.at(std::string(path) + "/" + variant).at(metric).is_number());
            }
        };
        const auto bytes_are_the_curve = [&](const std::string& variant) {
            CAPTURE(variant);
            const auto& figures = json.at(std::string(path) + "/" + variant);
            CHECK(columns.at(variant + "_bytes").size() == 12);
            CHECK(figures.at("bytes_per_frame") == doctest::Approx(mean(columns.at(variant + "_bytes"))));
            CHECK(figures.at("imagery_bytes_per_frame") ==
                  doctest::Approx(mean(columns.at(variant + "_imagery_bytes"))));
            CHECK(figures.at("bytes_per_frame").get<double>() ==
                  doctest::Approx(figures.at("imagery_bytes_per_frame").get<double>() +
                                  figures.at("heights_bytes_per_frame").get<double>()));
        };
        for (const char* variant : kDrawn) {
            metrics(variant,
                    {"start_bytes", "fps_mean", "frame_ms.mean", "frame_ms.p99", "cpu_percent.process",
                     "cpu_percent.render", "per_frame.imagery_missing", "tiles_in"});
            bytes_are_the_curve(variant);
            CHECK(json.at(std::string(path) + "/" + variant).at("frame_ms.mean").get<double>() ==
                  doctest::Approx(mean(columns.at(std::string(variant) + "_frame_ms"))).epsilon(0.01));
        }
        for (const char* variant : kReckoned) {
            metrics(variant,
                    {"start_bytes", "bytes_per_m", "imagery_window_texels", "heights_window_texels"});
            bytes_are_the_curve(variant);
        }
    }
    CHECK(app::scheduling_table(report->figures).find("orbit/clipmap_lean") != std::string::npos);
}

TEST_CASE("scheduling suite: what is sent anew in every frame is far more than what is kept, on every path") {
    GlContext gl;
    if (!gl) return;
    const SmallGround ground(Layers::imagery);
    const auto report = app::run_scheduling_suite(*ground.store, small_suite());
    REQUIRE(report);
    const auto value = [&](const std::string& variant, const char* metric) {
        return *report->figures.find(variant, metric);
    };
    for (const std::string path : {"ground/", "orbit/"}) {
        CAPTURE(path);
        CHECK(value(path + "cpu_lod", "imagery_bytes_per_frame") > 0.0);
        CHECK(value(path + "cpu_lod", "heights_bytes_per_frame") >
              value(path + "off", "heights_bytes_per_frame"));
        // Before the first frame, a clipmap has all that lies about the eye, whether it is seen or not.
        CHECK(value(path + "clipmap", "start_bytes") > 0.0);
        CHECK(value(path + "clipmap_rgb8", "start_bytes") > value(path + "clipmap", "start_bytes"));
        CHECK(value(path + "clipmap_lean", "start_bytes") < value(path + "clipmap", "start_bytes"));
    }
}

TEST_CASE("scheduling suite: clipmaps' windows follow from the view as tiles are chosen") {
    GlContext gl;
    if (!gl) return;
    const SmallGround ground(Layers::imagery);
    const io::ImageryInfo& imagery = *ground.store->info().imagery;
    const app::ClipmapView view{.projection_px = 60.0, .pixel_error_px = 2.0, .side_cosine = 0.8};
    const auto levels = app::imagery_clipmap(imagery, view);
    REQUIRE(levels.size() == static_cast<std::size_t>(imagery.grid().levels()));
    for (std::size_t i = 1; i < levels.size(); ++i) {
        CHECK(levels[i].reach_m == doctest::Approx(levels[i - 1].texel_m.x * 60.0 / (2.0 * 0.8)));
        const app::ClipmapWindow window(levels[i], app::kStoreFormats.imagery);
        // 4 P / (e cos a) texels and two blocks.
        CHECK(window.size_texels() == app::BlockPlace(156));
    }
    CHECK(levels.back().texels == app::BlockPlace(imagery.width, imagery.height));
    const auto heights = app::vertex_clipmap(ground.store->info(), ground.store->records(), view);
    REQUIRE(heights.size() == static_cast<std::size_t>(ground.store->grid().levels()));
    for (std::size_t i = 2; i < heights.size(); ++i) CHECK(heights[i].reach_m <= heights[i - 1].reach_m);
    const auto samples = app::sample_clipmap(ground.store->info(), view);
    REQUIRE(samples.size() == heights.size());
    const double sample_px = app::heights_pixel_error_px(60.0, 2.0);
    for (std::size_t i = 1; i < samples.size(); ++i)
        CHECK(samples[i].reach_m == doctest::Approx(samples[i - 1].texel_m.x * 60.0 / (sample_px * 0.8)));
}

TEST_CASE("scheduling suite: a store without imagery is refused, and says what would mend it") {
    GlContext gl;
    if (!gl) return;
    const SmallGround ground(Layers::heights);
    const auto report = app::run_scheduling_suite(*ground.store, small_suite());
    REQUIRE(!report);
    CHECK(report.error().message.find("no imagery") != std::string::npos);
    CHECK(report.error().message.find("--imagery") != std::string::npos);
    CHECK(report.error().message.find('\n') == std::string::npos);
}
