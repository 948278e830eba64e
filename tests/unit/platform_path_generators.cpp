#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "ridgeline/platform/path_generators.h"

namespace ridgeline::platform {
namespace {

// Mountains in the east, a plain and a flat sea in the west.
std::optional<double> half_mountains(const glm::dvec2& place) {
    const double mountains = std::clamp((place.x - 25'000.0) / 5'000.0, 0.0, 1.0);
    return mountains * (900.0 * std::sin(place.x / 1100.0) * std::cos(place.y / 1300.0) + 1000.0) +
           5.0 * std::sin(place.x / 200.0);
}
const Box kBounds{{0.0, 0.0, 0.0}, {50'000.0, 40'000.0, 1905.0}};

double slope_over_1_km(const glm::dvec2& p) {
    const double across = *half_mountains({p.x + 500, p.y}) - *half_mountains({p.x - 500, p.y});
    const double along = *half_mountains({p.x, p.y + 500}) - *half_mountains({p.x, p.y - 500});
    return std::hypot(across, along) / 1000.0;
}

double median_slope() {
    std::vector<double> slopes;
    for (double y = 500; y < 39'500; y += 400)
        for (double x = 500; x < 49'500; x += 400) slopes.push_back(slope_over_1_km({x, y}));
    std::ranges::nth_element(slopes, slopes.begin() + static_cast<std::ptrdiff_t>(slopes.size() / 2));
    return slopes[slopes.size() / 2];
}

ResolvedPath walk() {
    const auto path = ground_path(kBounds, half_mountains);
    REQUIRE(path);
    auto resolved = resolve(*path, half_mountains);
    REQUIRE(resolved);
    return *resolved;
}

TEST_CASE("the walk is a round of 1800 frames at 30 m/s, two metres above the ground") {
    const ResolvedPath path = walk();
    REQUIRE(path.frame_count() == 1800);
    for (std::size_t i = 0; i < 1800; ++i) {
        const glm::dvec3& here = path.frame(i).eye_m;
        const glm::dvec3& next = path.frame(i + 1).eye_m;
        CHECK(here.z == doctest::Approx(*half_mountains(glm::dvec2(here)) + 2.0));
        CHECK(glm::distance(glm::dvec2(here), glm::dvec2(next)) == doctest::Approx(0.5).epsilon(0.02));
    }
}

TEST_CASE("the walk stays in country steeper than the median") {
    const ResolvedPath path = walk();
    const double median = median_slope();
    std::size_t steep = 0;
    for (std::size_t i = 0; i < 1800; ++i)
        steep += slope_over_1_km(glm::dvec2(path.frame(i).eye_m)) > median ? 1 : 0;
    CHECK(steep > 1700);
}

TEST_CASE("the walk looks where it goes, about level, and turns gently") {
    const ResolvedPath path = walk();
    for (std::size_t i = 0; i < 1800; ++i) {
        const Pose& here = path.frame(i);
        const Pose& next = path.frame(i + 1);
        const glm::dvec2 along = glm::dvec2(next.eye_m) - glm::dvec2(here.eye_m);
        const Angle course = Angle::from_radians(std::atan2(along.x, along.y));
        CHECK(std::abs(shortest_turn(here.heading, course).degrees()) < 3.0);
        CHECK(std::abs(here.pitch.degrees()) < 15.0);
        // Degrees a frame: 45 and 10 a second.
        CHECK(std::abs(shortest_turn(here.heading, next.heading).degrees()) < 0.75);
        CHECK(std::abs((next.pitch - here.pitch).degrees()) < 1.0 / 6.0);
    }
}

TEST_CASE("the same data give the same walk, another seed another") {
    const auto first = ground_path(kBounds, half_mountains);
    const auto second = ground_path(kBounds, half_mountains);
    const auto other = ground_path(kBounds, half_mountains, {.seed = 2});
    REQUIRE((first && second && other));
    CHECK(path_to_json(*first) == path_to_json(*second));
    CHECK(path_to_json(*first) != path_to_json(*other));
}

TEST_CASE("small, flat and holed data still get a walk inside them, empty data none") {
    const Box small{{0.0, 0.0, 0.0}, {300.0, 200.0, 1.0}};
    const auto flat = ground_path(small, [](const glm::dvec2&) { return std::optional(1.0); });
    REQUIRE(flat);
    for (const auto& sample : flat->samples) {
        CHECK(sample.pose.eye_m.x > 0.0);
        CHECK(sample.pose.eye_m.x < 300.0);
        CHECK(sample.pose.eye_m.y > 0.0);
        CHECK(sample.pose.eye_m.y < 200.0);
    }
    const auto holed = [](const glm::dvec2& place) {
        return place.x > 30'000.0 ? half_mountains(place) : std::nullopt;
    };
    CHECK(ground_path(kBounds, holed));
    CHECK_FALSE(ground_path(kBounds, [](const glm::dvec2&) { return std::optional<double>(); }));
}

TEST_CASE("the orbit looks at the centre from above the highest ground, smoothly, round after round") {
    const auto resolved = resolve(orbit_path(kBounds), half_mountains);
    REQUIRE(resolved);
    REQUIRE(resolved->frame_count() == 3600);
    const glm::dvec3 center = (kBounds.min + kBounds.max) / 2.0;
    for (std::size_t i = 0; i < 3600; ++i) {
        const Pose& pose = resolved->frame(i);
        CHECK(pose.eye_m.z > kBounds.max.z);
        CHECK(glm::dot(forward(pose), glm::normalize(center - pose.eye_m)) > 0.99999);
        CHECK(std::abs(shortest_turn(pose.heading, resolved->frame(i + 1).heading).degrees()) < 0.2);
    }
}

}  // namespace
}  // namespace ridgeline::platform
