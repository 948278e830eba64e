#include <doctest/doctest.h>

#include <cmath>

#include "ridgeline/select/criterion.h"
#include "ridgeline/select/finest_nodes.h"
#include "ridgeline/select/view.h"
#include "unit/select_scene.h"

namespace ridgeline::test {
namespace {

io::TerrainInfo plain_info() {
    io::TerrainInfo info;
    info.width = 1025;
    info.height = 1025;
    info.spacing_x_m = 10.0;
    info.spacing_y_m = 20.0;
    return info;
}

select::SwitchingRule rule_of(const char* name, const select::View& view,
                              const select::CriterionOptions& options = {}) {
    const io::TerrainInfo info = plain_info();
    return select::make_criterion(name, options).value()->rule(view, info, info.grid());
}

}  // namespace

TEST_CASE("screen_error: at the switching distance the error covers exactly the tolerated pixels") {
    select::View view;
    view.projection_px = 700.0;
    view.pixel_error_px = 2.0;
    view.exaggeration = 3.0;
    // More than a third of the samples' spacing at that level: the error decides.
    const double at_m = rule_of("screen_error", view).distance_m(500.0f, 1);
    CHECK(500.0 * view.exaggeration * view.projection_px / at_m == doctest::Approx(view.pixel_error_px));
}

TEST_CASE("screen_error: of ground without error, samples are at most three tolerated pixels apart") {
    select::View view;
    view.projection_px = 700.0;
    view.pixel_error_px = 2.0;
    view.exaggeration = 3.0;
    const auto rule = rule_of("screen_error", view);
    const io::Grid grid = plain_info().grid();
    for (int level = 0; level < grid.levels(); ++level) {
        const double spacing_m = static_cast<double>(grid.step(level)) * 20.0;
        CHECK(spacing_m * view.projection_px / rule.distance_m(0.0f, level) ==
              doctest::Approx(3.0 * view.pixel_error_px));
    }
}

TEST_CASE("distance: a node splits within so many of its longer sides, whatever its error") {
    const auto rule = rule_of("distance", {}, {.distance_factor = 3.0});
    const io::Grid grid = plain_info().grid();
    for (int level = 0; level < grid.levels(); ++level) {
        const double side_m = static_cast<double>(grid.extent(level)) * 20.0;
        CHECK(rule.distance_m(0.0f, level) == doctest::Approx(3.0 * side_m));
        CHECK(rule.distance_m(1000.0f, level) == rule.distance_m(0.0f, level));
    }
}

TEST_CASE("roughness: the larger of side and weighted error decides") {
    const auto rule = rule_of("roughness", {}, {.roughness_factor = 2.0, .roughness_weight = 100.0});
    const double side_m = static_cast<double>(plain_info().grid().extent(2)) * 20.0;
    CHECK(rule.distance_m(0.0f, 2) == doctest::Approx(2.0 * side_m));
    CHECK(rule.distance_m(1e6f, 2) == doctest::Approx(2.0 * 100.0 * 1e6));
}

TEST_CASE(
    "cells divide by the criteria's own options, and by the error on the screen where there is no other "
    "rule") {
    select::View view;
    view.projection_px = 700.0;
    view.pixel_error_px = 2.0;
    // A cell's error is drawn with it already.
    view.exaggeration = 3.0;
    const select::CriterionOptions options{
        .distance_factor = 3.0, .roughness_factor = 5.0, .roughness_weight = 70.0};
    const auto rule_of_cells = [&](const char* name) {
        return select::make_criterion(name, options).value()->cell_rule(view, 8);
    };
    for (const char* name : {"screen_error", "density"}) {
        CHECK(rule_of_cells(name).by_error == doctest::Approx(350.0));
        CHECK(rule_of_cells(name).by_spacing == 0.0);
    }
    CHECK(rule_of_cells("distance").by_error == 0.0);
    CHECK(rule_of_cells("distance").by_spacing == doctest::Approx(3.0 * 8 / 2.0));
    CHECK(rule_of_cells("roughness").by_error == doctest::Approx(5.0 * 70.0 / 2.0));
    CHECK(rule_of_cells("roughness").by_spacing == doctest::Approx(5.0 * 8 / 2.0));
}

TEST_CASE("density: at the switching distance eq. 7 gives the threshold") {
    select::View view;
    view.eye_above_ground_m = 50.0;
    const auto rule = rule_of("density", view, {.density_triangles_per_radian = 1e4});
    const io::Grid grid = plain_info().grid();
    for (int level = 0; level < grid.levels(); ++level) {
        const double x = rule.distance_m(7.0f, level), d = static_cast<double>(grid.step(level)) * 20.0;
        CHECK(x * x / (d * 50.0) * 2.0 * grid.quads() == doctest::Approx(1e4));
    }
}

TEST_CASE("switching distances never grow downwards, for any criterion and view") {
    const Scene scene({300, 180, 32, 1});
    Random random(1);
    for (const char* name : {"screen_error", "distance", "roughness", "density"})
        for (int i = 0; i < 50; ++i) {
            const auto view = random_view(scene, random);
            const int finest = scene.grid().finest();
            const double within_m = i % 2 == 0 ? 0.0 : 10.0 * i;
            const auto rule = select::with_finest_within(
                select::make_criterion(name).value()->rule(view, scene.info(), scene.grid()), within_m,
                finest);
            for (int level = 0; level < finest; ++level) CHECK(rule.distance_m(0.0f, level) >= within_m);
            for (std::int64_t k = scene.grid().first(1); k < scene.grid().node_count(); ++k) {
                const io::NodeId node = scene.grid().node_at(k);
                const auto error_m = [&](io::NodeId n) {
                    return scene.records()[static_cast<std::size_t>(scene.grid().linear(n))].error_m;
                };
                CHECK(rule.distance_m(error_m(node), node.level) <=
                      rule.distance_m(error_m(node.parent()), node.level - 1));
            }
        }
}

namespace {

// As the look at each node finds them.
std::vector<select::NearNode> nodes_within(const Scene& scene, const select::View& view,
                                           const select::NodeReach& reach) {
    const io::TerrainInfo& info = scene.info();
    const io::Grid& grid = scene.grid();
    const double quantum_m = info.quantum_m * view.exaggeration;
    std::vector<select::NearNode> nodes;
    for (std::int64_t k = grid.first(grid.finest()); k < grid.node_count(); ++k) {
        const io::NodeId node = grid.node_at(k);
        const io::NodeRecord& record = scene.records()[static_cast<std::size_t>(k)];
        const auto side = static_cast<double>(grid.extent(node.level));
        const auto north_west = info.world(node.x * side, node.y * side);
        const auto south_east = info.world((node.x + 1) * side, (node.y + 1) * side);
        const glm::dvec3 nearest = glm::clamp(
            view.eye_m,
            glm::dvec3(north_west.x, south_east.y, info.height_offset_m + record.min_quanta * quantum_m),
            glm::dvec3(south_east.x, north_west.y, info.height_offset_m + record.max_quanta * quantum_m));
        const double within_m = std::min(
            std::max(reach.least_m, reach.by_error * static_cast<double>(record.error_m)), reach.most_m);
        const double distance_m = glm::distance(nearest, view.eye_m);
        if (record.has_data() && distance_m < within_m) nodes.push_back({node, distance_m});
    }
    return nodes;
}

}  // namespace

TEST_CASE("the finest nodes about the eye are those that a look at each finds, the nearest of them") {
    Random random(29);
    std::size_t found = 0, cut = 0;
    std::vector<select::NearNode> nodes = {{{0, 0, 0}, 1.0}};
    for (int trial = 0; trial < 8; ++trial) {
        const Scene scene(
            {trial == 0 ? 20 : 300 + 60 * trial, trial == 0 ? 20 : 180, 32, static_cast<unsigned>(trial)});
        for (int i = 0; i < 40; ++i) {
            auto view = random_view(scene, random);
            if (i == 7) view.eye_m.x += 1e7;
            const double least_m = 20.0 * i * scene.info().spacing_x_m;
            const select::NodeReach reach{least_m, i == 9 ? 1e12 : 3.0 * least_m, 10.0 * i};
            const auto expected = nodes_within(scene, view, reach);
            const std::size_t most = i % 3 == 0 ? 5 : 10'000;
            select::find_finest_within(scene.info(), scene.records(), view, reach, most, nodes);
            REQUIRE(nodes.size() == std::min(most, expected.size()));
            REQUIRE(std::ranges::is_sorted(nodes, {}, &select::NearNode::distance_m));
            for (const select::NearNode& near : nodes)
                REQUIRE(std::ranges::any_of(expected, [&](const select::NearNode& other) {
                    return other.node == near.node &&
                           other.distance_m == doctest::Approx(near.distance_m).epsilon(1e-9);
                }));
            found += nodes.size();
            if (nodes.size() == expected.size()) continue;
            ++cut;
            CHECK(std::ranges::count_if(expected, [&](const select::NearNode& other) {
                      return other.distance_m < nodes.back().distance_m - 1e-6;
                  }) < static_cast<std::ptrdiff_t>(most));
        }
    }
    CHECK(found > 1000);
    CHECK(cut > 10);
}

TEST_CASE("an unknown criterion is refused by name, with those that exist") {
    const auto made = select::make_criterion("quality");
    REQUIRE(!made);
    CHECK(made.error().message.find("'quality'") != std::string::npos);
    CHECK(made.error().message.find("screen_error, distance, roughness or density") != std::string::npos);
}

TEST_CASE("the extension zone holds every ball that comes within its cone and margin") {
    Random random(2);
    const auto direction = [&] {
        return glm::normalize(
            glm::dvec3(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)));
    };
    for (int i = 0; i < 20000; ++i) {
        const Angle half_angle = Angle::from_degrees(uniform(random, 1.0, 180.0));
        const select::ExtensionZone zone(direction(), half_angle, uniform(random, 0.0, 50.0));
        const glm::dvec3 eye(uniform(random, -9, 9), 5.0, -3.0);
        // A point of the cone from an eye within the margin, and a ball that holds it.
        const glm::dvec3 apex = eye + uniform(random, 0.0, zone.margin_m) * direction();
        glm::dvec3 ray = direction();
        while (glm::dot(ray, zone.direction) < std::cos(half_angle.radians()))
            ray = direction() + 2.0 * zone.direction;
        ray = glm::normalize(ray);
        if (glm::dot(ray, zone.direction) < std::cos(half_angle.radians())) continue;
        const glm::dvec3 point = apex + uniform(random, 0.0, 500.0) * ray;
        const double radius_m = uniform(random, 0.1, 20.0);
        CHECK(touches(zone, eye, point + 0.99 * radius_m * direction(), radius_m));
    }
    const select::ExtensionZone narrow({0, 1, 0}, Angle::from_degrees(20.0), 1.0);
    CHECK(!touches(narrow, {0, 0, 0}, {0, -100, 0}, 10.0));
    CHECK(!touches(narrow, {0, 0, 0}, {100, 0, 0}, 10.0));
}

TEST_CASE("a view's frustum holds what its camera projects into the picture, and a pixel more") {
    Random random(3);
    const Scene scene({66, 34, 32, 5});
    for (int i = 0; i < 200; ++i) {
        select::Camera camera;
        camera.horizontal_field = Angle::from_degrees(uniform(random, 20.0, 120.0));
        camera.width_px = 640;
        camera.height_px = 480;
        const auto view = select::make_view(camera, {});
        const auto inside = [&](double x_px, double y_px) {
            const glm::dvec3 p = camera.eye_m + 100.0 * (view.projection_px * camera.forward +
                                                         x_px * camera.right + y_px * camera.up);
            return contains(view.visible, {p, p}) != Containment::outside;
        };
        CHECK(inside(320.0, 240.0));
        CHECK(inside(-320.9, -240.9));
        CHECK(!inside(321.1, 0.0));
        CHECK(!inside(0.0, -241.1));
    }
}

TEST_CASE("the eye frame adds up to the eye, on the terrain and far from it") {
    io::TerrainInfo info = plain_info();
    info.west_m = 3.2e5;
    info.north_m = 2.7e6;
    info.quantum_m = 1.0 / 32.0;
    info.height_offset_m = -120.0;
    info.max_height_m = 4000.0;
    Random random(4);
    for (int i = 0; i < 1000; ++i) {
        select::View view;
        view.exaggeration = uniform(random, 0.5, 4.0);
        view.eye_m = {info.west_m + uniform(random, -2e4, 3e4), info.north_m + uniform(random, -3e4, 2e4),
                      uniform(random, -500.0, 30000.0)};
        const auto frame = select::eye_frame(view, info);
        const glm::dvec2 place = info.lattice(view.eye_m.x, view.eye_m.y);
        CHECK(frame.cell.x + static_cast<double>(frame.cell_rest.x) ==
              doctest::Approx(place.x).epsilon(1e-6));
        CHECK(frame.cell.y + static_cast<double>(frame.cell_rest.y) ==
              doctest::Approx(place.y).epsilon(1e-6));
        const double quanta = frame.quanta + static_cast<double>(frame.quanta_rest);
        const double height_m = info.height_offset_m + quanta * info.quantum_m * view.exaggeration;
        CHECK(height_m == doctest::Approx(view.eye_m.z).epsilon(1e-6));
    }
}

}  // namespace ridgeline::test
