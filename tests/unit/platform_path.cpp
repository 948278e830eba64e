#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <random>

#include "ridgeline/platform/path.h"

namespace ridgeline::platform {
namespace {

std::optional<double> hills(const glm::dvec2& place) {
    return 500.0 + 40.0 * std::sin(place.x / 130.0) * std::cos(place.y / 90.0);
}
std::optional<double> no_ground(const glm::dvec2&) { return std::nullopt; }

PathSample sample_at(double t_s, const glm::dvec3& eye, double heading_deg = 0.0, double pitch_deg = 0.0,
                     HeightReference reference = HeightReference::absolute) {
    return {Seconds(t_s), {eye, Angle::from_degrees(heading_deg), Angle::from_degrees(pitch_deg)}, reference};
}

// Random places at random but increasing times that are whole frames.
CameraPath random_path(std::mt19937_64& random, HeightReference reference) {
    std::uniform_real_distribution<double> place(-2000.0, 2000.0);
    std::uniform_int_distribution<int> frames(1, 90);
    CameraPath path;
    int frame = 0;
    for (int i = 0; i < 12; ++i, frame += frames(random))
        path.samples.push_back(sample_at(frame / 60.0, {place(random), place(random), 10.0 + i},
                                         place(random), place(random) / 40.0, reference));
    return path;
}

const Pose& frame_at(const ResolvedPath& path, Seconds t) {
    return path.frame(static_cast<std::size_t>(std::lround(t.count() * 60.0)));
}

TEST_CASE("every sample is met exactly at its time") {
    std::mt19937_64 random(1);
    for (int i = 0; i < 50; ++i) {
        const CameraPath path = random_path(random, HeightReference::absolute);
        const auto resolved = resolve(path, no_ground);
        REQUIRE(resolved);
        for (const auto& sample : path.samples) {
            const Pose& pose = frame_at(*resolved, sample.t);
            CHECK(glm::distance(pose.eye_m, sample.pose.eye_m) < 1e-6);
            CHECK(std::abs(shortest_turn(pose.heading, sample.pose.heading).degrees()) < 1e-6);
            CHECK(std::abs((pose.pitch - sample.pose.pitch).degrees()) < 1e-6);
        }
    }
}

TEST_CASE("at even times the spline is the well-known Catmull-Rom spline") {
    CameraPath path;
    const double x[] = {0.0, 10.0, -5.0, 30.0};
    for (int i = 0; i < 4; ++i) path.samples.push_back(sample_at(i, {x[i], 0.0, 0.0}));
    const auto resolved = resolve(path, no_ground);
    REQUIRE(resolved);
    for (double s : {0.25, 0.5, 0.75}) {
        const double expected =
            0.5 * (2 * x[1] + (x[2] - x[0]) * s + (2 * x[0] - 5 * x[1] + 4 * x[2] - x[3]) * s * s +
                   (3 * x[1] - x[0] - 3 * x[2] + x[3]) * s * s * s);
        CHECK(frame_at(*resolved, Seconds(1.0 + s)).eye_m.x == doctest::Approx(expected));
    }
}

TEST_CASE("even motion stays even, however unevenly it is sampled") {
    CameraPath path;
    for (double t : {0.0, 0.1, 0.15, 0.7, 0.75, 2.0})
        path.samples.push_back(sample_at(t, {30.0 * t, -4.0 * t, 100.0}));
    const auto resolved = resolve(path, no_ground);
    REQUIRE(resolved);
    for (std::size_t i = 0; i < resolved->frame_count(); ++i)
        CHECK(resolved->frame(i).eye_m.x == doctest::Approx(0.5 * static_cast<double>(i)));
}

TEST_CASE("angles turn the short way") {
    CameraPath path;
    path.samples = {sample_at(0.0, {0, 0, 0}, 350.0, -10.0), sample_at(1.0, {1, 0, 0}, 20.0, 10.0)};
    const auto resolved = resolve(path, no_ground);
    REQUIRE(resolved);
    const Pose& half = frame_at(*resolved, Seconds(0.5));
    CHECK(std::remainder(half.heading.degrees() - 5.0, 360.0) == doctest::Approx(0.0));
    CHECK(half.pitch.degrees() == doctest::Approx(0.0));
}

TEST_CASE("past its end a path holds its last sample, also between frames") {
    CameraPath path;
    path.samples = {sample_at(5.0, {0, 0, 0}), sample_at(6.004, {100, 0, 0}, 90.0)};
    const auto resolved = resolve(path, no_ground);
    REQUIRE(resolved);
    CHECK(resolved->frame_count() == 62);
    for (std::size_t index : {61U, 62U, 100000U}) CHECK(resolved->frame(index).eye_m.x == 100.0);
    CHECK(resolved->at(Seconds(0.0)).eye_m.x == 0.0);
    CHECK(resolved->at(Seconds(1e6)).eye_m.x == 100.0);
    CHECK(resolved->at(Seconds(1e6)).heading.degrees() == doctest::Approx(90.0));
}

TEST_CASE("a path of one sample is one frame") {
    CameraPath path;
    path.samples = {sample_at(3.0, {1, 2, 3}, 45.0)};
    const auto resolved = resolve(path, no_ground);
    REQUIRE(resolved);
    CHECK(resolved->frame_count() == 1);
    CHECK(resolved->duration() == Seconds(0.0));
    CHECK(resolved->at(Seconds(9.0)).eye_m == glm::dvec3(1, 2, 3));
}

TEST_CASE("a path above the ground follows it between its samples too") {
    CameraPath path;
    for (int i = 0; i < 5; ++i)
        path.samples.push_back(
            sample_at(2.0 * i, {400.0 * i, 90.0 * i * i, 2.0}, 0.0, 0.0, HeightReference::above_ground));
    const auto resolved = resolve(path, hills);
    REQUIRE(resolved);
    for (std::size_t i = 0; i < resolved->frame_count(); ++i) {
        const glm::dvec3& eye = resolved->frame(i).eye_m;
        CHECK(eye.z == doctest::Approx(*hills(glm::dvec2(eye)) + 2.0));
    }
}

TEST_CASE("above the ground never falls below what its samples say") {
    CameraPath path;
    const double above[] = {2.0, 2.0, 2.0, 300.0, 300.0, 2.0, 2.0};
    for (int i = 0; i < 7; ++i)
        path.samples.push_back(
            sample_at(i, {100.0 * i, 0.0, above[i]}, 0.0, 0.0, HeightReference::above_ground));
    const auto resolved = resolve(path, hills);
    REQUIRE(resolved);
    for (std::size_t i = 0; i < resolved->frame_count(); ++i) {
        const glm::dvec3& eye = resolved->frame(i).eye_m;
        CHECK(eye.z - *hills(glm::dvec2(eye)) >= 2.0 - 1e-9);
    }
}

TEST_CASE("samples of both kinds join without a jump") {
    CameraPath path;
    path.samples = {sample_at(0.0, {0, 0, 2}, 0, 0, HeightReference::above_ground),
                    sample_at(1.0, {30, 5, 2}, 0, 0, HeightReference::above_ground),
                    sample_at(2.0, {60, 0, 600}), sample_at(3.0, {90, 9, 600})};
    const auto resolved = resolve(path, hills);
    REQUIRE(resolved);
    CHECK(resolved->frame(0).eye_m.z == doctest::Approx(*hills({0, 0}) + 2.0));
    CHECK(resolved->frame(60).eye_m.z == doctest::Approx(*hills({30, 5}) + 2.0));
    CHECK(resolved->frame(120).eye_m.z == doctest::Approx(600.0));
    for (std::size_t i = 1; i < resolved->frame_count(); ++i)
        CHECK(glm::distance(resolved->frame(i).eye_m, resolved->frame(i - 1).eye_m) < 5.0);
}

TEST_CASE("over gaps in the data the ground stays what it was; without any data the path fails") {
    CameraPath path;
    for (int i = 0; i < 4; ++i)
        path.samples.push_back(sample_at(i, {100.0 * i, 0.0, 2.0}, 0.0, 0.0, HeightReference::above_ground));
    const auto half = [](const glm::dvec2& place) {
        return place.x < 150.0 ? std::optional(700.0) : std::nullopt;
    };
    const auto resolved = resolve(path, half);
    REQUIRE(resolved);
    CHECK(resolved->frame(180).eye_m.z == doctest::Approx(702.0));
    CHECK_FALSE(resolve(path, no_ground));
}

TEST_CASE("a repeating path has neither jump nor kink where it starts again") {
    CameraPath path;
    path.end = PathEnd::repeat;
    for (int i = 0; i <= 12; ++i) {
        const double turn = i * 3.14159265358979323846 / 6.0;
        path.samples.push_back(sample_at(i, {100.0 * std::sin(turn), 100.0 * std::cos(turn), 0.0}));
    }
    const auto resolved = resolve(path, no_ground);
    REQUIRE(resolved);
    const std::size_t count = resolved->frame_count();
    CHECK(count == 720);
    CHECK(resolved->frame(count).eye_m == resolved->frame(0).eye_m);
    const glm::dvec3 before = resolved->frame(count).eye_m - resolved->frame(count - 1).eye_m;
    const glm::dvec3 after = resolved->frame(count + 1).eye_m - resolved->frame(count).eye_m;
    CHECK(glm::distance(before, after) < 0.02);
    CHECK(glm::length(before) == doctest::Approx(glm::length(after)).epsilon(0.01));
}

TEST_CASE("what is written is read back the same") {
    std::mt19937_64 random(5);
    CameraPath path = random_path(random, HeightReference::absolute);
    path.samples[3].reference = HeightReference::above_ground;
    const auto file = std::filesystem::temp_directory_path() / "ridgeline_path_test.json";
    REQUIRE(save_path(path, file));
    const auto again = load_path(file);
    std::filesystem::remove(file);
    REQUIRE(again);
    REQUIRE(again->samples.size() == path.samples.size());
    for (std::size_t i = 0; i < path.samples.size(); ++i) {
        CHECK(again->samples[i].t == path.samples[i].t);
        CHECK(again->samples[i].pose.eye_m == path.samples[i].pose.eye_m);
        CHECK(again->samples[i].reference == path.samples[i].reference);
        CHECK(
            std::abs(shortest_turn(again->samples[i].pose.heading, path.samples[i].pose.heading).degrees()) <
            1e-9);
    }
}

std::string one_sample(const std::string& fields) {
    return R"({"format": "ridgeline-path-1", "samples": [{)" + fields + "}]}";
}

TEST_CASE("nonsense is refused in one line that names the file and the fault") {
    const std::string good =
        R"("t": 0, "east": 1, "north": 2, "height": 3, "heading_deg": 4, "pitch_deg": 5)";
    REQUIRE(parse_path(one_sample(good), "a.json"));
    const std::pair<std::string, std::string> cases[] = {
        {"", "not JSON"},
        {"{", "not JSON"},
        {"[1, 2]", "\"format\""},
        {R"({"samples": []})", "\"format\""},
        {R"({"format": "ridgeline-path-2", "samples": []})", "\"format\""},
        {R"({"format": "ridgeline-path-1"})", "\"samples\""},
        {R"({"format": "ridgeline-path-1", "samples": []})", "\"samples\""},
        {R"({"format": "ridgeline-path-1", "samples": [7]})", "samples[0]: not an object"},
        {one_sample(R"("t": 0, "east": 1)"), "'north' is missing"},
        {one_sample(R"("t": "0")"), "'t' is not a number"},
        {one_sample(R"("t": NaN)"), "not JSON"},
        {one_sample(R"("t": 1e999)"), "not JSON"},
        {one_sample(good + R"(, "above_ground": 2)"), "both"},
        {one_sample(R"("t": 0, "east": 1, "north": 2, "height": 3, "heading_deg": 4, "pitch_deg": 95)"),
         "pitch_deg"},
        {one_sample(good + "}, {" + good), "samples[1]: 't' does not increase"},
        {one_sample(good +
                    R"(}, {"t": 1e9, "east": 1, "north": 2, "height": 3, "heading_deg": 4, "pitch_deg": 5)"),
         "more than a day"}};
    for (const auto& named : cases) {
        // clang cannot capture structured bindings.
        const auto& text = named.first;
        const auto& fault = named.second;
        CAPTURE(text);
        const auto path = parse_path(text, "a.json");
        REQUIRE_FALSE(path);
        CHECK(path.error().message.starts_with("a.json: "));
        CHECK(path.error().message.find(fault) != std::string::npos);
        CHECK(path.error().message.find('\n') == std::string::npos);
    }
    CHECK_FALSE(load_path("/nowhere/at/all.json"));
}

TEST_CASE("a path cut short at any byte is refused") {
    std::mt19937_64 random(6);
    std::string text = path_to_json(random_path(random, HeightReference::absolute));
    // The last line end does not matter.
    text.pop_back();
    for (std::size_t length = 0; length < text.size(); ++length)
        CHECK_FALSE(parse_path(std::string_view(text).substr(0, length), "cut"));
    CHECK(parse_path(text, "whole"));
}

}  // namespace
}  // namespace ridgeline::platform
