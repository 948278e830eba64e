// The program's command line as a black box: help, wrong usage, and options that this release lacks.
#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "unit/app_process.h"

using namespace ridgeline::test;

namespace {

const std::vector<std::string> kCommands = {"synth",  "build", "info",  "verify",
                                            "height", "walk",  "bench", "report"};

}  // namespace

TEST_CASE("every command has help with an example, and help is no error") {
    const Answer whole = run({"--help"});
    CHECK(whole.status == 0);
    for (const std::string& command : kCommands) {
        INFO(command);
        CHECK(whole.out.find("\n  " + command) != std::string::npos);
        const Answer help = run({command, "--help"});
        CHECK(help.status == 0);
        CHECK(help.err.empty());
        CHECK(help.out.find("Example:\n  ridgeline " + command) != std::string::npos);
    }
}

TEST_CASE("the version is one line") {
    const Answer answer = run({"--version"});
    CHECK(answer.status == 0);
    CHECK(answer.out.starts_with("ridgeline "));
    CHECK(std::count(answer.out.begin(), answer.out.end(), '\n') == 1);
}

TEST_CASE("no command, or one that does not exist, is wrong usage") {
    check_usage_error({}, "no command");
    check_usage_error({"frobnicate", "--help"}, "frobnicate");
    check_usage_error({"fly"}, "fly");
    check_usage_error({"--fly"}, "--fly");
}

TEST_CASE("what a command needs is asked for by name") {
    check_usage_error({"synth"}, "OUT.tif");
    check_usage_error({"build", "dem.tif"}, "--out");
    check_usage_error({"build", "--out", "x.terrain"}, "DEM");
    check_usage_error({"info"}, "DIR.terrain");
    check_usage_error({"verify"}, "DIR.terrain");
    check_usage_error({"bench", "x.terrain", "--out", "d"}, "--suite");
    check_usage_error({"bench", "x.terrain", "--suite", "metric"}, "--out");
    check_usage_error({"height", "x.terrain"}, "--at");
    check_usage_error({"walk"}, "DIR.terrain");
}

TEST_CASE("strange and repeated options are named") {
    check_usage_error({"info", "x.terrain", "--frobnicate"}, "--frobnicate");
    check_usage_error({"info", "x.terrain", "y.terrain"}, "y.terrain");
    check_usage_error({"walk", "x.terrain", "--size", "10x10", "--size", "20x20"}, "--size");
    check_usage_error({"walk", "x.terrain", "--size"}, "--size");
}

TEST_CASE("values that cannot be are named with their option") {
    const std::vector<std::vector<std::string>> walk = {
        {"--size", "0x7"},          {"--size", "20000x10"}, {"--fov", "0"},
        {"--fov", "180"},           {"--frames", "0"},      {"--frames", "1.5"},
        {"--seconds", "0"},         {"--fps-limit", "-1"},  {"--surface", "cube"},
        {"--pixel-error", "0"},     {"--sun", "noon"},      {"--exaggeration", "0"},
        {"--background", "purple"}, {"--ram-cache", "0"},   {"--gpu-cache", "lots"},
        {"--fault", "delay=50"},    {"--shot", "1:a.jpg"},  {"--log-level", "silly"},
    };
    for (const auto& option : walk) check_usage_error({"walk", "x.terrain", option[0], option[1]}, option[0]);
    check_usage_error({"synth", "x.tif", "--size", "1"}, "--size");
    check_usage_error({"synth", "x.tif", "--spacing", "0"}, "--spacing");
    check_usage_error({"build", "x.tif", "--out", "x.terrain", "--imagery", ""}, "--imagery");
    check_usage_error({"build", "", "--out", "x.terrain"}, "DEM");
    check_usage_error({"build", "x.tif", "--out", "x.terrain", "--crs", "mercator"}, "--crs");
    check_usage_error({"build", "x.tif", "--out", "x.terrain", "--tile", "64"}, "--tile");
    check_usage_error({"build", "x.tif", "--out", "x.terrain", "--memory", "1PB"}, "--memory");
    check_usage_error({"build", "x.tif", "--out", "x.terrain", "--memory", "0"}, "--memory");
    check_usage_error({"build", "x.tif", "--out", "x.terrain", "--jobs", "0"}, "--jobs");
    check_usage_error({"build", "x.tif", "--out", "x.terrain", "--nodata", "none"}, "--nodata");
    check_usage_error({"build", "x.tif", "--out", "x.terrain", "--metric", "curvature"}, "--metric");
    check_usage_error({"height", "x.terrain", "--at", "1"}, "--at");
    check_usage_error({"bench", "x.terrain", "--suite", "speed", "--out", "d"}, "--suite");
}

TEST_CASE("what one suite of the bench is told is wrong usage with another, wherever it stands") {
    const auto bench = [](std::vector<std::string> more) {
        more.insert(more.begin(), {"bench", "absent.terrain", "--out", "d"});
        return more;
    };
    for (const char* cache : {"--ram-cache", "--gpu-cache"}) {
        check_usage_error(bench({"--suite", "metric", cache, "8MiB"}), cache);
        check_usage_error(bench({cache, "8MiB", "--suite", "metric"}), cache);
        check_usage_error(bench({"--suite", "horizon", cache, "none"}), cache);
    }
    check_usage_error(bench({"--suite", "metric", "--frames", "3"}), "--frames");
    check_usage_error(bench({"--suite", "horizon", "--source", "x.tif"}), "--source");
    check_usage_error(bench({"--suite", "scheduling", "--views", "3"}), "--views");
    check_usage_error(bench({"--suite", "scheduling", "--source", "x.tif"}), "--source");
    check_usage_error(bench({"--suite", "scheduling", "--frames", "0"}), "--frames");
    check_usage_error(bench({"--suite", "stress", "--views", "3"}), "--views");
    check_usage_error(bench({"--suite", "stress", "--variant", "soft"}), "--variant");
    check_usage_error(bench({"--suite", "horizon", "--beside", "x.terrain"}), "--beside");
    check_usage_error(bench({"--suite", "horizon", "--frobnicate"}), "--frobnicate");
    check_failure({"bench", "absent.terrain", "--suite", "horizon", "--out", "/dev/null/d", "--ram-cache",
                   "8MiB", "--gpu-cache", "16MiB", "--frames", "3"},
                  "/dev/null/d");
}

TEST_CASE("frames and seconds exclude each other") {
    check_usage_error({"walk", "x.terrain", "--frames", "3", "--seconds", "3"}, "--frames");
}

TEST_CASE("what is of imagery is wrong usage without any") {
    check_usage_error({"build", "x.tif", "--out", "x.terrain", "--gpu"}, "--gpu");
}

TEST_CASE("what no option offers is wrong usage") {
    check_usage_error({"build", "--out", "x.terrain", "--imagery", "a.tif", "--tile", "33"}, "--tile");
    check_usage_error({"height", "x.terrain", "--at", "1,2", "--detail", "9"}, "--detail");
    check_usage_error({"bench", "x.terrain", "--suite", "speed", "--out", "d"},
                      "--suite: 'speed' is not known");
}

TEST_CASE("octaves of made ground that no store foretells are wrong usage") {
    for (const char* levels : {"9", "0", "-1", "2.5", "on"})
        check_usage_error({"walk", "x.terrain", "--detail", levels}, "--detail");
    check_usage_error({"walk", "x.terrain", "--detail", "3", "--detail-roughness", "5"},
                      "--detail-roughness");
}

TEST_CASE("values that name what this release does are accepted") {
    // A store that is not there is the first thing that fails, so the options passed.
    check_failure({"walk", "absent.terrain", "--headless", "--surface", "mesh", "--criterion", "screen_error",
                   "--horizon", "off", "--lod", "gpu", "--detail", "off", "--shadows", "off"},
                  "absent.terrain");
    check_failure({"walk", "absent.terrain", "--headless", "--surface", "quadtree", "--lod", "cpu"},
                  "absent.terrain");
    check_failure({"walk", "absent.terrain", "--headless", "--surface", "disc", "--detail", "8",
                   "--detail-roughness", "0.5"},
                  "absent.terrain");
    for (const char* horizon : {"boxes", "ridges"})
        check_failure({"walk", "absent.terrain", "--headless", "--horizon", horizon}, "absent.terrain");
    for (const char* metric : {"cone", "geometric"})
        check_failure({"build", "absent.tif", "--out", "x.terrain", "--metric", metric}, "absent.tif");
}

TEST_CASE("quiet and log level stand before or behind the command") {
    check_failure({"--quiet", "--log-level", "error", "info", "absent.terrain"}, "absent.terrain");
    check_failure({"info", "absent.terrain", "--quiet", "--log-level", "off"}, "absent.terrain");
    check_usage_error({"--log-level", "silly", "info", "x.terrain"}, "--log-level");
}
