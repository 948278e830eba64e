// What `walk` is told arrives as values, with the defaults that users rely on, and is described as it took
// effect.
#include "ridgeline/app/commands/walk_options.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

using namespace ridgeline;
using namespace ridgeline::app;
using namespace std::chrono_literals;

namespace {

WalkOptions parsed(const std::vector<std::string>& arguments) {
    WalkOptions options;
    Program program({"ridgeline", "", "", ""});
    add_walk_options(program.add("walk", "", ""), options);
    program.runs("walk", [](const RunContext&) { return Result<void>(); });
    std::vector<const char*> argv = {"ridgeline", "walk"};
    for (const std::string& argument : arguments) argv.push_back(argument.c_str());
    const auto run = program.parse(static_cast<int>(argv.size()), argv.data());
    REQUIRE(run);
    CHECK(*run != nullptr);
    return options;
}

telemetry::OptionValue value_of(const WalkOptions& options, const std::string& name) {
    for (const auto& [key, value] : described(options))
        if (key == name) return value;
    return std::string("absent");
}

}  // namespace

TEST_CASE("defaults are those of the interface") {
    const WalkOptions options = parsed({"alps.terrain"});
    CHECK(options.directory == "alps.terrain");
    CHECK(options.size_px == glm::ivec2(1024, 768));
    CHECK(options.horizontal_fov.degrees() == doctest::Approx(75.0));
    CHECK(options.pixel_error == 1.0);
    CHECK(options.exaggeration == 1.0);
    CHECK(options.caches.ram_bytes == 256_MiB);
    CHECK(options.caches.gpu_bytes == 512_MiB);
    CHECK(options.drawing == Drawing::window);
    CHECK(options.surface == "mesh");
    CHECK(options.imagery == "on");
    CHECK(options.criterion == "screen_error");
    CHECK(!options.faults.any());
    CHECK((!options.path && !options.frames && !options.seconds && !options.sun && !options.background));
}

TEST_CASE("every option arrives") {
    const WalkOptions options = parsed({"alps.terrain",
                                        "--path",
                                        "ground",
                                        "--record",
                                        "out.json",
                                        "--headless",
                                        "--size",
                                        "333x257",
                                        "--fov",
                                        "90",
                                        "--frames",
                                        "60",
                                        "--fps-limit",
                                        "30",
                                        "--imagery",
                                        "off",
                                        "--pixel-error",
                                        "2",
                                        "--sun",
                                        "135,-2",
                                        "--exaggeration",
                                        "1.5",
                                        "--background",
                                        "FF00FF",
                                        "--ram-cache",
                                        "64MiB",
                                        "--gpu-cache",
                                        "1GiB",
                                        "--wait-for-tiles",
                                        "--fault",
                                        "delay=50ms,error=0.1,until=9",
                                        "--shot",
                                        "0:a.png",
                                        "--shot",
                                        "59:b.png",
                                        "--hud",
                                        "--telemetry",
                                        "t"});
    CHECK(options.imagery == "off");
    CHECK(std::get<std::string>(value_of(options, "imagery")) == "off");
    CHECK(options.path->kind == PathChoice::Kind::ground);
    CHECK(options.record == "out.json");
    CHECK(options.drawing == Drawing::headless);
    CHECK(options.size_px == glm::ivec2(333, 257));
    CHECK(options.horizontal_fov.degrees() == doctest::Approx(90.0));
    CHECK(options.frames == 60);
    CHECK(options.fps_limit == 30.0);
    CHECK(options.pixel_error == 2.0);
    CHECK(std::get<SunDirection>(*options.sun).elevation.degrees() == doctest::Approx(-2.0));
    CHECK(options.exaggeration == 1.5);
    CHECK(options.background == Colour{255, 0, 255});
    CHECK(options.caches.ram_bytes == 64_MiB);
    CHECK(options.caches.gpu_bytes == 1_GiB);
    CHECK(options.wait_for_tiles);
    CHECK(options.faults.delay == 50ms);
    CHECK(options.faults.until_frame == 9);
    REQUIRE(options.shots.size() == 2);
    CHECK(options.shots[1].frame == 59);
    CHECK(options.shots[1].file == "b.png");
    CHECK(options.hud);
    CHECK(options.telemetry == "t");
}

TEST_CASE("the store may stand behind the shots") {
    const WalkOptions options = parsed({"--shot", "0:a.png", "alps.terrain", "--hud"});
    CHECK(options.directory == "alps.terrain");
    CHECK(options.shots.size() == 1);
}

TEST_CASE("the map comes with the figures") {
    const WalkOptions options = parsed({"alps.terrain", "--hud-map"});
    CHECK(options.hud);
    CHECK(options.hud_map);
    CHECK_FALSE(parsed({"alps.terrain", "--hud"}).hud_map);
}

TEST_CASE("options are described as they took effect, so that the description can be given again") {
    const std::vector<std::string> arguments = {"alps.terrain",
                                                "--path",
                                                "ground",
                                                "--sun",
                                                "2026-06-21T09:00Z",
                                                "--fault",
                                                "delay=1.5ms,corrupt=0.01,seed=7",
                                                "--background",
                                                "00FF7f"};
    const WalkOptions options = parsed(arguments);
    CHECK(value_of(options, "size") == telemetry::OptionValue("1024x768"));
    CHECK(value_of(options, "path") == telemetry::OptionValue("ground"));
    CHECK(value_of(options, "sun") == telemetry::OptionValue("2026-06-21T09:00:00Z"));
    CHECK(value_of(options, "background") == telemetry::OptionValue("00FF7F"));
    CHECK(value_of(options, "frames") == telemetry::OptionValue("absent"));
    const auto faults = pager::parse_fault(std::get<std::string>(value_of(options, "fault")));
    CHECK(faults->delay == 1500us);
    CHECK(faults->corrupt == 0.01);
    CHECK(faults->seed == 7);
}
