#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "ridgeline/select/seen_ground.h"
#include "unit/select_scene.h"

namespace ridgeline::test {
namespace {

using select::GroundBounds;
using select::GroundReadback;
using select::GroundRectangle;
using select::SeenGround;

GroundRectangle about(const glm::dvec2& place, double by) { return {place - by, place + by}; }

select::Camera random_camera(const GroundRectangle& terrain, Random& random) {
    select::Camera camera;
    const glm::dvec2 share(uniform(random, 0.0, 1.0), uniform(random, 0.0, 1.0));
    camera.eye_m = {glm::mix(terrain.min, terrain.max, share), uniform(random, 0.0, 3000.0)};
    const double heading = uniform(random, 0.0, 6.3), pitch = uniform(random, -1.5, 1.0);
    camera.forward = {std::sin(heading) * std::cos(pitch), std::cos(heading) * std::cos(pitch),
                      std::sin(pitch)};
    camera.right = {std::cos(heading), -std::sin(heading), 0.0};
    camera.up = glm::cross(camera.right, camera.forward);
    return camera;
}

// The camera after a turn of its heading.
select::Camera turned(select::Camera camera, double by) {
    const auto turn = [by](const glm::dvec3& v) {
        return glm::dvec3(v.x * std::cos(by) + v.y * std::sin(by), v.y * std::cos(by) - v.x * std::sin(by),
                          v.z);
    };
    camera.forward = turn(camera.forward), camera.right = turn(camera.right), camera.up = turn(camera.up);
    return camera;
}

// A terrain that is all there, and what is seen of it.
struct SeenScene {
    Scene terrain{{300, 180, 32, 3}};
    GroundBounds bounds{terrain.info(), terrain.records()};
    std::unique_ptr<const select::Criterion> criterion = select::make_criterion("screen_error").value();
    select::Selection selection{terrain.info(), terrain.records(), *criterion};
    decltype(all_resident(terrain)) residency = all_resident(terrain);
    SeenGround seen{terrain.info(), bounds.terrain()};
};

}  // namespace

TEST_CASE("seen ground: without a readback every drawn quarter is seen, and little else") {
    SeenScene scene;
    Random random(1);
    int unseen = 0;
    for (int i = 0; i < 60; ++i) {
        const select::View view = random_view(scene.terrain, random);
        const auto& selected = scene.selection.run(view, scene.residency);
        const auto ground = scene.seen.see(view, {.eye_m = view.eye_m}, selected, nullptr);
        for (const Unit& unit : units_of(scene.terrain, selected.draws)) {
            const double column = static_cast<double>(unit.x) + uniform(random, 0.0, 1.0) * unit.side;
            const double row = static_cast<double>(unit.y) + uniform(random, 0.0, 1.0) * unit.side;
            const glm::dvec2 at = scene.terrain.info().world(std::min(column, 299.0), std::min(row, 179.0));
            CHECK(ground.sees(about(at, 0.01)));
        }
        for (int j = 0; j < 50; ++j) {
            const glm::dvec2 at =
                scene.terrain.info().world(uniform(random, 0.0, 299.0), uniform(random, 0.0, 179.0));
            unseen += !ground.sees(about(at, 0.01));
        }
    }
    CHECK(unseen > 100);
}

TEST_CASE(
    "seen ground: a late readback counts alone while the camera rests, with what is drawn after a turn") {
    SeenScene scene;
    Random random(2);
    int drawn_places = 0;
    for (int i = 0; i < 60; ++i) {
        const select::Camera camera = random_camera(scene.bounds.terrain(), random);
        const glm::dvec2 place = glm::mix(scene.bounds.terrain().min, scene.bounds.terrain().max, 0.5);
        GroundReadback late{.sight = select::sight_of(camera), .rectangle = about(place, 1.0), .mask = {}};
        late.mask.clear(scene.seen.lattice(), glm::dvec2(camera.eye_m));
        late.mask.mark(late.rectangle);
        for (const double turn : {0.0, 0.01, 0.3, 2.0}) {
            const select::Camera now = turned(camera, turn);
            const select::View view = select::make_view(now, {});
            const auto& selected = scene.selection.run(view, scene.residency);
            const auto ground = scene.seen.see(view, select::sight_of(now), selected, &late);
            CHECK(ground.sees(about(place, 0.01)));
            CHECK(ground.seen.size() == (turn < 0.1 ? 1 : 2));
            if (turn < 0.1) {
                // As the mask, the rectangle is widened for what a small move brings into view.
                const glm::dvec2 away = glm::abs(place - glm::dvec2(camera.eye_m)) / 16.0;
                const glm::dvec2 cell = glm::max(away, glm::dvec2(scene.seen.lattice().cell_m)) * 1.1 + 1.0;
                CHECK(glm::all(glm::lessThan(ground.rectangle.min, late.rectangle.min)));
                CHECK(glm::all(glm::greaterThan(ground.rectangle.min, late.rectangle.min - cell)));
                continue;
            }
            for (const Unit& unit : units_of(scene.terrain, selected.draws)) {
                if (unit.x + unit.side / 2 >= 300 || unit.y + unit.side / 2 >= 180) continue;
                const glm::dvec2 at = scene.terrain.info().world(static_cast<double>(unit.x + unit.side / 2),
                                                                 static_cast<double>(unit.y + unit.side / 2));
                CHECK(ground.sees(about(at, 0.01)));
                ++drawn_places;
            }
        }
    }
    CHECK(drawn_places > 1000);
}

TEST_CASE("seen ground: what an eye could reach within the paging latency may soon be seen, in its picture") {
    SeenScene scene;
    Random random(3);
    for (int i = 0; i < 20; ++i) {
        select::Camera camera = random_camera(scene.bounds.terrain(), random);
        for (const double speed_m_per_s : {0.0, 60.0}) {
            camera.speed_m_per_s = speed_m_per_s;
            const select::View view = select::make_view(camera, {.paging_latency = std::chrono::seconds(2)});
            const auto ground = scene.seen.see(view, select::sight_of(camera),
                                               scene.selection.run(view, scene.residency), nullptr);
            CHECK(ground.soon_m == doctest::Approx(2.0 * speed_m_per_s));
            const glm::dvec3 ahead = camera.eye_m + 50.0 * camera.forward,
                             behind = camera.eye_m - 50.0 * camera.forward;
            CHECK(ground.may_see_soon({ahead, ahead}) == (speed_m_per_s > 0.0));
            CHECK_FALSE(ground.may_see_soon({behind, behind}));
        }
    }
}

}  // namespace ridgeline::test
