// Measuring on the ground: rays, lines, clicks, and the one who looks.
#include <doctest/doctest.h>

#include <chrono>
#include <cmath>
#include <random>
#include <thread>

#include "ridgeline/app/hud/measure_panel.h"
#include "ridgeline/app/walk/measure.h"
#include "ridgeline/app/walk/surveyor.h"
#include "support/small_store.h"

using namespace ridgeline;
using namespace ridgeline::app;
using namespace ridgeline::test;
using platform::MouseButton;

namespace {

using Random = std::mt19937_64;
double uniform(Random& random, double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
}

platform::Camera random_camera(Random& random) {
    platform::Camera camera;
    camera.lens.size_px = {640, 400};
    camera.lens.horizontal_fov = Angle::from_degrees(uniform(random, 20.0, 110.0));
    camera.pose = {{uniform(random, -3e5, 3e5), uniform(random, 2e6, 3e6), uniform(random, -100.0, 9e3)},
                   Angle::from_degrees(uniform(random, -180.0, 180.0)),
                   Angle::from_degrees(uniform(random, -80.0, 80.0))};
    return camera;
}

std::int32_t hills(std::int64_t x, std::int64_t y) {
    return static_cast<std::int32_t>(std::lround(20.0 * std::sin(0.13 * static_cast<double>(x)) +
                                                 15.0 * std::cos(0.09 * static_cast<double>(y))));
}

struct SmallGround {
    SmallGround() : terrain(io::Grid(129, 97, 32), hills), files(terrain) {
        auto opened = io::Store::open(files.directory());
        REQUIRE(opened.ok());
        store = std::make_unique<io::Store>(std::move(opened).value());
    }
    GroundRay down_on(double column, double row) const {
        return {{store->info().world(column, row), 1000.0}, {0.0, 0.0, -1.0}};
    }

    ReferenceTerrain terrain;
    SmallStore files;
    std::unique_ptr<io::Store> store;
};

SurveyAnswer answer_to(Surveyor& surveyor, std::uint64_t number) {
    while (true) {
        const SurveyAnswer* found = surveyor.take();
        if (found && found->number == number) return *found;
        std::this_thread::yield();
    }
}

platform::Input mouse(const glm::dvec2& at_px, const glm::dvec2& motion_px = {}) {
    platform::Input input;
    input.mouse_position_px = at_px;
    input.mouse_motion_px = motion_px;
    return input;
}

platform::Input held(platform::Input input, MouseButton button) {
    input.buttons_down.set(static_cast<std::size_t>(button));
    return input;
}

platform::Input pressed(platform::Input input, MouseButton button) {
    input.buttons_pressed.set(static_cast<std::size_t>(button));
    return input;
}

}  // namespace

TEST_CASE(
    "measure: what a ray through a place in the picture meets appears at that place, exaggerated or not") {
    Random random(1);
    for (int i = 0; i < 500; ++i) {
        const platform::Camera camera = random_camera(random);
        const VerticalScale scale{uniform(random, -500.0, 500.0), std::exp2(uniform(random, -3.0, 4.0))};
        const glm::dvec2 place(uniform(random, 0.0, 1.0), uniform(random, 0.0, 1.0));
        const GroundRay ray = ray_through(camera, scale, place);
        const auto at = ray.origin_m + uniform(random, 1.0, 1e5) * ray.direction;
        const auto seen = picture_place(camera, scale, at);
        REQUIRE(seen);
        CHECK(glm::distance(*seen, place) < 1e-6);
        CHECK_FALSE(picture_place(camera, scale, ray.origin_m - 10.0 * ray.direction));
        CHECK(scale.true_m(scale.drawn_m(at.z)) == doctest::Approx(at.z));
    }
}

TEST_CASE("measure: distance, bearing, ways up and down of a line") {
    const glm::dvec3 from(1000.0, 2000.0, 10.0);
    const float gap = std::nanf("");
    const float heights[] = {10.0f, 30.0f, gap, 20.0f, 50.0f};
    const LineFigures line = line_figures(from, {1300.0, 1600.0, 50.0}, heights);
    CHECK(line.level_m == doctest::Approx(500.0));
    CHECK(line.straight_m == doctest::Approx(std::hypot(500.0, 40.0)));
    CHECK(line.bearing.degrees() == doctest::Approx(180.0 - std::atan2(300.0, 400.0) * 180.0 / M_PI));
    CHECK(line.rise_m == doctest::Approx(40.0));
    CHECK(line.ascent_m == doctest::Approx(50.0));
    CHECK(line.descent_m == doctest::Approx(10.0));
    CHECK(line.lowest_m == 10.0);
    CHECK(line.highest_m == 50.0);
    CHECK(line_figures(from, from + glm::dvec3(-1.0, 0.0, 0.0), {}).bearing.degrees() ==
          doctest::Approx(270.0));
    CHECK(line_figures(from, from + glm::dvec3(0.0, 1.0, 0.0), {}).bearing.degrees() == doctest::Approx(0.0));
    CHECK(line_figures(from, from, {}).level_m == 0.0);
}

TEST_CASE("measure: steps of a graph's grid are round, and no more than asked for") {
    Random random(2);
    for (int i = 0; i < 1000; ++i) {
        const double range = std::pow(10.0, uniform(random, -3.0, 7.0));
        const double step = round_step(range, 5);
        CHECK(range / step <= 5.0 * (1.0 + 1e-12));
        CHECK(range / step > 1.9);
        const double digit = step / std::pow(10.0, std::floor(std::log10(step) + 1e-9));
        CHECK((std::abs(digit - 1.0) < 1e-6 || std::abs(digit - 2.0) < 1e-6 || std::abs(digit - 5.0) < 1e-6));
    }
}

TEST_CASE("clicks: pressed and let go in one place, within one frame or over many; not after a drag") {
    ClickWatch clicks;
    const glm::dvec2 at(30.0, 40.0);
    // The way to where the button went down does not count.
    CHECK_FALSE(clicks.update(held(pressed(mouse(at, {200.0, 0.0}), MouseButton::left), MouseButton::left)));
    CHECK_FALSE(clicks.update(held(mouse(at, {1.0, 1.0}), MouseButton::left)));
    const auto click = clicks.update(mouse(at));
    REQUIRE(click);
    CHECK((click->button == MouseButton::left));
    CHECK(click->at_px == at);
    CHECK_FALSE(clicks.update(mouse(at)));

    const auto tapped = clicks.update(pressed(mouse(at), MouseButton::right));
    REQUIRE(tapped);
    CHECK((tapped->button == MouseButton::right));

    CHECK_FALSE(clicks.update(held(pressed(mouse(at), MouseButton::left), MouseButton::left)));
    // There and back is a drag, too.
    CHECK_FALSE(clicks.update(held(mouse(at, {9.0, 0.0}), MouseButton::left)));
    CHECK_FALSE(clicks.update(held(mouse(at, {-9.0, 0.0}), MouseButton::left)));
    CHECK_FALSE(clicks.update(mouse(at)));

    platform::Input looking = pressed(mouse(at), MouseButton::left);
    looking.mouse_captured = true;
    CHECK_FALSE(clicks.update(looking));
}

TEST_CASE("surveyor: points and profile are the finest level's") {
    const SmallGround ground;
    Surveyor surveyor(*ground.store);
    select::SurfaceQuery surface(*ground.store);
    Random random(3);
    for (std::uint64_t number = 1; number <= 50; ++number) {
        SurveyQuestion question{.number = number, .rays = 2};
        for (GroundRay& ray : question.ray) {
            ray = ground.down_on(uniform(random, 1.0, 127.0), uniform(random, 1.0, 95.0));
            ray.direction += glm::dvec3(uniform(random, -0.01, 0.01), uniform(random, -0.01, 0.01), 0.0);
        }
        surveyor.ask(question);
        const SurveyAnswer answer = answer_to(surveyor, number);
        CHECK(answer.failure.empty());
        for (std::size_t i = 0; i < 2; ++i) {
            const auto hit =
                surface.ray_cast(question.ray[i].origin_m, question.ray[i].direction, 1e9).value();
            REQUIRE(answer.points_m[i].has_value() == hit.hit);
            if (hit.hit) CHECK(*answer.points_m[i] == hit.point_m);
        }
        if (!answer.points_m[0] || !answer.points_m[1]) continue;
        const glm::dvec3 from = *answer.points_m[0], to = *answer.points_m[1];
        REQUIRE(answer.profile.size() == profile_samples(from, to, ground.store->info().spacing_x_m));
        for (std::size_t i = 0; i < answer.profile.size(); ++i) {
            const double share = static_cast<double>(i) / static_cast<double>(answer.profile.size() - 1);
            const auto height =
                surface.height(glm::mix(from.x, to.x, share), glm::mix(from.y, to.y, share)).value();
            REQUIRE((height.kind == select::SurfaceHeight::Kind::ground));
            CHECK(static_cast<double>(answer.profile[i]) == doctest::Approx(height.height_m));
        }
        CHECK(static_cast<double>(answer.profile.front()) == doctest::Approx(from.z));
        CHECK(static_cast<double>(answer.profile.back()) == doctest::Approx(to.z));
    }
}

TEST_CASE("surveyor: a ray into the sky meets nothing, and of many questions the newest is answered") {
    const SmallGround ground;
    Surveyor surveyor(*ground.store);
    surveyor.ask({.number = 1, .rays = 1, .ray = {GroundRay{{0.0, 0.0, 500.0}, {0.0, 0.0, 1.0}}}});
    CHECK_FALSE(answer_to(surveyor, 1).points_m[0]);
    for (std::uint64_t number = 2; number < 300; ++number)
        surveyor.ask({.number = number,
                      .rays = 2,
                      .ray = {ground.down_on(2.0, 2.0), ground.down_on(2.0 + number % 120, 90.0)}});
    const SurveyAnswer last = answer_to(surveyor, 299);
    REQUIRE(last.points_m[1]);
    CHECK(last.points_m[1]->x == doctest::Approx(ground.store->info().world(2.0 + 299 % 120, 90.0).x));
    // One that is at work when the surveyor goes ends with it.
    surveyor.ask({.number = 300, .rays = 2, .ray = {ground.down_on(2.0, 2.0), ground.down_on(120.0, 90.0)}});
}
