#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

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

}  // namespace

TEST_CASE("seen ground: without a readback every drawn quarter is seen, and little else") {
    const Scene scene({300, 180, 32, 3});
    const GroundBounds bounds(scene.info(), scene.records());
    const auto criterion = select::make_criterion("screen_error").value();
    select::Selection selection(scene.info(), scene.records(), *criterion);
    const auto residency = all_resident(scene);
    SeenGround seen(scene.info(), bounds.terrain());
    Random random(1);
    int unseen = 0;
    for (int i = 0; i < 60; ++i) {
        const select::View view = random_view(scene, random);
        const auto& selected = selection.run(view, residency);
        const auto ground = seen.see(view, {.eye_m = view.eye_m}, selected, nullptr);
        for (const Unit& unit : units_of(scene, selected.draws)) {
            const double column = static_cast<double>(unit.x) + uniform(random, 0.0, 1.0) * unit.side;
            const double row = static_cast<double>(unit.y) + uniform(random, 0.0, 1.0) * unit.side;
            const glm::dvec2 at = scene.info().world(std::min(column, 299.0), std::min(row, 179.0));
            CHECK(ground.sees(about(at, 0.01)));
        }
        for (int j = 0; j < 50; ++j) {
            const glm::dvec2 at =
                scene.info().world(uniform(random, 0.0, 299.0), uniform(random, 0.0, 179.0));
            unseen += !ground.sees(about(at, 0.01));
        }
    }
    CHECK(unseen > 100);
}

TEST_CASE(
    "seen ground: a late readback counts alone while the camera rests, with what is drawn after a turn") {
    const Scene scene({300, 180, 32, 3});
    const GroundBounds bounds(scene.info(), scene.records());
    const auto criterion = select::make_criterion("screen_error").value();
    select::Selection selection(scene.info(), scene.records(), *criterion);
    const auto residency = all_resident(scene);
    SeenGround seen(scene.info(), bounds.terrain());
    Random random(2);
    int drawn_places = 0;
    for (int i = 0; i < 60; ++i) {
        const select::Camera camera = random_camera(bounds.terrain(), random);
        const glm::dvec2 place = glm::mix(bounds.terrain().min, bounds.terrain().max, 0.5);
        GroundReadback late{.sight = select::sight_of(camera), .rectangle = about(place, 1.0), .mask = {}};
        late.mask.clear(seen.lattice(), glm::dvec2(camera.eye_m));
        late.mask.mark(late.rectangle);
        for (const double turn : {0.0, 0.01, 0.3, 2.0}) {
            const select::Camera now = turned(camera, turn);
            const select::View view = select::make_view(now, {});
            const auto& selected = selection.run(view, residency);
            const auto ground = seen.see(view, select::sight_of(now), selected, &late);
            CHECK(ground.sees(about(place, 0.01)));
            CHECK(ground.seen.size() == (turn < 0.1 ? 1 : 2));
            if (turn < 0.1) {
                // As the mask, the rectangle is widened for what a small move brings into view.
                const glm::dvec2 away = glm::abs(place - glm::dvec2(camera.eye_m)) / 16.0;
                const glm::dvec2 cell = glm::max(away, glm::dvec2(seen.lattice().cell_m)) * 1.1 + 1.0;
                CHECK(glm::all(glm::lessThan(ground.rectangle.min, late.rectangle.min)));
                CHECK(glm::all(glm::greaterThan(ground.rectangle.min, late.rectangle.min - cell)));
                continue;
            }
            for (const Unit& unit : units_of(scene, selected.draws)) {
                if (unit.x + unit.side / 2 >= 300 || unit.y + unit.side / 2 >= 180) continue;
                const glm::dvec2 at = scene.info().world(static_cast<double>(unit.x + unit.side / 2),
                                                         static_cast<double>(unit.y + unit.side / 2));
                CHECK(ground.sees(about(at, 0.01)));
                ++drawn_places;
            }
        }
    }
    CHECK(drawn_places > 1000);
}

}  // namespace ridgeline::test
