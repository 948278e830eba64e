// The journeys of suite `stress`: over any terrain they are the same on every run, stay over ground, and are
// as fast as they say.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "ridgeline/app/bench/stress_paths.h"

using namespace ridgeline;
using namespace ridgeline::app;

namespace {

constexpr Box kBounds{{300'000.0, 2'600'000.0, 0.0}, {380'000.0, 2'680'000.0, 1000.0}};

// A ridge from south to north at the middle, and nothing in the west.
std::optional<double> ridge(const glm::dvec2& place) {
    const glm::dvec2 in = place - glm::dvec2(kBounds.min);
    if (in.x < 10'000.0 || in.y < 0.0 || in.x > 80'000.0 || in.y > 80'000.0) return std::nullopt;
    return 1000.0 - 0.02 * std::abs(in.x - 40'000.0);
}

std::map<std::string, platform::ResolvedPath> laid() {
    auto paths = stress_paths(kBounds, ridge);
    REQUIRE(paths);
    std::map<std::string, platform::ResolvedPath> by_name;
    for (StressPath& path : *paths) by_name.emplace(path.name, std::move(path.path));
    return by_name;
}

double over_ground_m(const platform::Pose& pose) {
    const auto ground = ridge(glm::dvec2(pose.eye_m));
    REQUIRE(ground);
    return pose.eye_m.z - *ground;
}

}  // namespace

TEST_CASE("stress paths: over ground all the way, and the same each time") {
    const auto paths = laid(), again = laid();
    REQUIRE(paths.size() == 4);
    for (const auto& [name, path] : paths) {
        CAPTURE(name);
        double least_m = 1e9;
        bool same = path.frame_count() == again.at(name).frame_count();
        for (std::size_t i = 0; i < path.frame_count(); ++i) {
            least_m = std::min(least_m, over_ground_m(path.frame(i)));
            same = same && path.frame(i).eye_m == again.at(name).frame(i).eye_m;
        }
        CHECK(least_m > 1.9);
        CHECK(same);
    }
}

TEST_CASE("stress paths: the sprint keeps to the ridge at a kilometre a second") {
    const auto paths = laid();
    const platform::ResolvedPath& sprint = paths.at("sprint");
    double length_m = 0.0;
    for (std::size_t i = 1; i < sprint.frame_count(); ++i)
        length_m += glm::distance(glm::dvec2(sprint.frame(i).eye_m), glm::dvec2(sprint.frame(i - 1).eye_m));
    CHECK(length_m / sprint.duration().count() == doctest::Approx(1000.0).epsilon(0.05));
    const double at_end_m = sprint.frame(sprint.frame_count() - 1).eye_m.x - kBounds.min.x;
    CHECK(at_end_m == doctest::Approx(40'000.0).epsilon(0.05));
}

TEST_CASE("stress paths: dives go from 20 km to 2 m, turns all the way round, teleports elsewhere") {
    const auto paths = laid();
    const platform::ResolvedPath& dives = paths.at("dives");
    CHECK(over_ground_m(dives.frame(0)) == doctest::Approx(20'000.0));
    CHECK(over_ground_m(dives.frame(dives.frame_count() - 1)) == doctest::Approx(2.0));
    const platform::ResolvedPath& turns = paths.at("turns");
    double turned = 0.0, farthest_m = 0.0;
    for (std::size_t i = 1; i < turns.frame_count(); ++i)
        turned +=
            std::abs(platform::shortest_turn(turns.frame(i - 1).heading, turns.frame(i).heading).degrees());
    CHECK(turned == doctest::Approx(4.0 * 360.0).epsilon(0.02));
    const platform::ResolvedPath& teleports = paths.at("teleports");
    for (std::size_t i = 1; i < teleports.frame_count(); ++i)
        farthest_m =
            std::max(farthest_m, glm::distance(teleports.frame(i - 1).eye_m, teleports.frame(i).eye_m));
    CHECK(farthest_m > 10'000.0);
}

TEST_CASE("stress paths: without ground there are none") {
    const auto paths =
        stress_paths(kBounds, [](const glm::dvec2&) -> std::optional<double> { return std::nullopt; });
    REQUIRE(!paths);
    CHECK(paths.error().message.find("ground") != std::string::npos);
}
