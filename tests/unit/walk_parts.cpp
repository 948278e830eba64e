// What a walk is made of, without a window: keys, courses, the sun, places in degrees, curves.
#include <doctest/doctest.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <random>
#include <set>

#include "ridgeline/app/hud/hud.h"
#include "ridgeline/app/walk/course.h"
#include "ridgeline/app/walk/place_names.h"
#include "ridgeline/app/walk/stage.h"
#include "ridgeline/app/walk/steering.h"
#include "ridgeline/app/walk/sun.h"
#include "ridgeline/select/horizon_profile.h"

using namespace ridgeline;
using namespace ridgeline::app;
using platform::Key;

namespace {

platform::Input pressing(Key key) {
    platform::Input input;
    input.keys_pressed.set(static_cast<std::size_t>(key));
    input.keys_down.set(static_cast<std::size_t>(key));
    return input;
}

platform::ResolvedPath straight_path() {
    std::vector<platform::Pose> poses;
    for (int i = 0; i <= 60; ++i) poses.push_back({{10.0 * i, 0.0, 500.0}, Angle(), Angle()});
    return {poses, kHeadlessFrameTime, platform::PathEnd::hold};
}

std::optional<double> no_ground(const glm::dvec2&) { return std::nullopt; }

}  // namespace

TEST_CASE("Each key does its one thing, and twice undoes it") {
    WalkSettings settings;
    for (int i = 0; i < 2; ++i) {
        apply_keys(pressing(Key::f1), settings);
        CHECK((settings.help == Panel::shown) == (i == 0));
        apply_keys(pressing(Key::f2), settings);
        CHECK((settings.hud == Panel::hidden) == (i == 0));
        apply_keys(pressing(Key::f3), settings);
        CHECK((settings.fill == render::Fill::wireframe) == (i == 0));
        apply_keys(pressing(Key::h), settings);
        CHECK((settings.horizon_view == Panel::shown) == (i == 0));
        // Asked for, the horizon's panels bring the figures with them.
        CHECK((settings.hud == Panel::shown));
        if (i == 0) apply_keys(pressing(Key::f2), settings);
        apply_keys(pressing(Key::m), settings);
        CHECK((settings.mouse == platform::MouseMode::captured) == (i == 0));
    }
    CHECK(apply_keys(pressing(Key::space), settings).pause);
    CHECK(apply_keys(pressing(Key::f), settings).walk_or_fly);
    CHECK(apply_keys(pressing(Key::r), settings).record);
    CHECK(apply_keys(pressing(Key::p), settings).replay);
    CHECK(apply_keys(pressing(Key::f12), settings).screenshot);
    CHECK(apply_keys(pressing(Key::home), settings).home);
}

TEST_CASE("Escape clears what was measured before it lets go of the mouse or leaves") {
    WalkSettings settings;
    settings.measured = Panel::shown;
    settings.mouse = platform::MouseMode::captured;
    CHECK_FALSE(apply_keys(pressing(Key::escape), settings).quit);
    CHECK((settings.measured == Panel::hidden));
    CHECK((settings.mouse == platform::MouseMode::captured));
    CHECK_FALSE(apply_keys(pressing(Key::escape), settings).quit);
    CHECK(apply_keys(pressing(Key::escape), settings).quit);
}

TEST_CASE("F4 goes round the kinds of shadows, and the arrows move the sun while they are held") {
    WalkSettings settings;
    for (const auto shadows : {select::CasterSet::pvs, select::CasterSet::all, select::CasterSet::none}) {
        apply_keys(pressing(Key::f4), settings);
        CHECK(settings.shadows == shadows);
    }
    const render::Daylight noon{Angle::from_degrees(180.0), Angle::from_degrees(60.0)};
    const std::chrono::duration<double> half_a_second(0.5);
    const auto after = [&](Key key) { return moved_sun(pressing(key), settings, noon, half_a_second); };
    CHECK(after(Key::right).sun_azimuth.degrees() == doctest::Approx(200.0));
    CHECK(after(Key::left).sun_azimuth.degrees() == doctest::Approx(160.0));
    CHECK(after(Key::up).sun_elevation.degrees() == doctest::Approx(67.5));
    CHECK(after(Key::down).sun_elevation.degrees() == doctest::Approx(52.5));
    CHECK(moved_sun({}, settings, noon, half_a_second).sun_elevation == noon.sun_elevation);
    CHECK(moved_sun(pressing(Key::up), settings, noon, half_a_second * 100.0).sun_elevation == kHighestSun);
    CHECK(moved_sun(pressing(Key::down), settings, noon, half_a_second * 100.0).sun_elevation == kLowestSun);
    settings.go_to = Panel::shown;
    CHECK(after(Key::right).sun_azimuth == noon.sun_azimuth);
}

TEST_CASE("F5 goes round the kinds of horizon, Z round the map's ranges") {
    WalkSettings settings;
    using select::HorizonMode;
    for (const auto horizon : {HorizonMode::off, HorizonMode::boxes, HorizonMode::ridges}) {
        apply_keys(pressing(Key::f5), settings);
        CHECK(settings.horizon == horizon);
    }
    for (const auto range : {MapRange::near, MapRange::far, MapRange::whole, MapRange::fitting}) {
        apply_keys(pressing(Key::z), settings);
        CHECK(settings.map_range == range);
    }
}

TEST_CASE("L brings the map with the quadtree's levels, and again what the horizon hides") {
    WalkSettings settings;
    settings.hud = Panel::hidden;
    apply_keys(pressing(Key::l), settings);
    CHECK(settings.hud == Panel::shown);
    CHECK(settings.horizon_view == Panel::shown);
    CHECK(settings.map_theme == MapTheme::levels);
    apply_keys(pressing(Key::l), settings);
    CHECK(settings.horizon_view == Panel::shown);
    CHECK(settings.map_theme == MapTheme::fates);
    apply_keys(pressing(Key::l), settings);
    apply_keys(pressing(Key::h), settings);
    // Hidden with the map, they come back with it at once.
    apply_keys(pressing(Key::l), settings);
    CHECK(settings.horizon_view == Panel::shown);
    CHECK(settings.map_theme == MapTheme::levels);
}

TEST_CASE("The horizon's panels come back with what brought them: the figures take them along") {
    WalkSettings settings;
    apply_keys(pressing(Key::h), settings);
    apply_keys(pressing(Key::f2), settings);
    CHECK(settings.hud == Panel::hidden);
    apply_keys(pressing(Key::h), settings);
    CHECK(settings.hud == Panel::shown);
    CHECK(settings.horizon_view == Panel::shown);
}

TEST_CASE("A map looks ahead of the eye, never past the terrain, and fits what is drawn") {
    HorizonScene scene;
    scene.least_m = {-50000.0f, -40000.0f};
    scene.most_m = {30000.0f, 60000.0f};
    scene.finest_side_m = 640.0f;
    scene.heading = Angle::from_degrees(90.0);
    std::vector<float> scratch;
    for (int i = 0; i < 10; ++i) {
        SceneNode node;
        node.side_m = {640.0f, 640.0f};
        node.corner_m = {1000.0f * static_cast<float>(i), 320.0f};
        node.report.quarters = node.report.in_view = node.report.drawn = 0b1111;
        scene.nodes.push_back(node);
    }
    const MapView fitting = map_view(scene, MapRange::fitting, scratch);
    CHECK(fitting.centre_m.x > 0.0f);
    CHECK(fitting.centre_m.y == doctest::Approx(0.0).epsilon(0.01));
    CHECK(fitting.centre_m.x + fitting.half_m > 7000.0f);
    CHECK(fitting.centre_m.x - fitting.half_m < 0.0f);
    CHECK(map_view(scene, MapRange::near, scratch).half_m < map_view(scene, MapRange::far, scratch).half_m);
    const MapView whole = map_view(scene, MapRange::whole, scratch);
    CHECK(whole.centre_m == glm::vec2(-10000.0f, 10000.0f));
    CHECK(whole.half_m > 50000.0f);
    scene.nodes.clear();
    CHECK(map_view(scene, MapRange::fitting, scratch).half_m <= whole.half_m);
}

TEST_CASE("The strip holds the level and all of the horizon") {
    HorizonScene scene;
    scene.profile.fill(select::kNotLookedAt);
    const ElevationRange nothing = elevation_range(scene);
    CHECK(nothing.least < 0.0f);
    CHECK(nothing.most > 0.0f);
    scene.profile[3] = 1.0f;
    scene.profile[9] = -std::numeric_limits<float>::infinity();
    const ElevationRange cliff = elevation_range(scene);
    CHECK(cliff.most > 45.0f);
    CHECK(cliff.most < 60.0f);
    CHECK(cliff.least > -15.0f);
    CHECK(cliff.least < 0.0f);
}

TEST_CASE("Escape closes what is open, lets go of the mouse, and only then leaves") {
    WalkSettings settings;
    settings.help = Panel::shown;
    settings.go_to = Panel::shown;
    settings.mouse = platform::MouseMode::captured;
    CHECK(!apply_keys(pressing(Key::escape), settings).quit);
    CHECK(settings.go_to == Panel::hidden);
    CHECK(!apply_keys(pressing(Key::escape), settings).quit);
    CHECK(settings.help == Panel::hidden);
    CHECK(!apply_keys(pressing(Key::escape), settings).quit);
    CHECK(settings.mouse == platform::MouseMode::free);
    CHECK(apply_keys(pressing(Key::escape), settings).quit);
    platform::Input closing;
    closing.close_requested = true;
    CHECK(apply_keys(closing, settings).quit);
}

TEST_CASE("While a place is typed, letters are text") {
    WalkSettings settings;
    settings.go_to = Panel::shown;
    const WalkRequests requests = apply_keys(pressing(Key::r), settings);
    CHECK(!requests.record);
    apply_keys(pressing(Key::m), settings);
    CHECK(settings.mouse == platform::MouseMode::free);
}

TEST_CASE("Exaggeration stays within its bounds and comes back to one") {
    WalkSettings settings;
    for (int i = 0; i < 200; ++i) apply_keys(pressing(Key::page_up), settings);
    CHECK(settings.exaggeration == kMostExaggeration);
    for (int i = 0; i < 200; ++i) apply_keys(pressing(Key::page_down), settings);
    CHECK(settings.exaggeration == kLeastExaggeration);
    apply_keys(pressing(Key::end), settings);
    CHECK(settings.exaggeration == 1.0);
}

TEST_CASE("A course follows its path, pauses, and is the user's as soon as they steer") {
    Course course(straight_path(), {});
    CHECK(course.state() == Course::State::following);
    course.advance({}, no_ground, Seconds(0.5));
    CHECK(course.pose().eye_m.x == doctest::Approx(300.0));
    CHECK(course.speed_m_per_s() == doctest::Approx(600.0));
    course.toggle_pause();
    course.advance({}, no_ground, Seconds(0.5));
    CHECK(course.pose().eye_m.x == doctest::Approx(300.0));
    course.toggle_pause();
    course.advance({}, no_ground, Seconds(0.1));
    CHECK(course.pose().eye_m.x == doctest::Approx(360.0));
    platform::Controls up;
    up.move = {0.0, 0.0, 1.0};
    course.advance(up, no_ground, Seconds(0.1));
    CHECK(course.state() == Course::State::steered);
    CHECK(course.pose().eye_m.z > 500.0);
    course.toggle_pause();
    CHECK(course.state() == Course::State::following);
}

TEST_CASE("Headless, a course shows the path's own frames") {
    Course course(straight_path(), {});
    for (const std::int64_t frame : {0, 1, 7, 60, 400}) {
        course.show_frame(frame);
        CHECK(course.pose().eye_m.x ==
              doctest::Approx(10.0 * static_cast<double>(std::min<std::int64_t>(frame, 60))));
    }
}

TEST_CASE("A recording played again passes through the places where it was made") {
    CourseRecording recording;
    for (int i = 0; i < 50; ++i)
        recording.add(kHeadlessFrameTime * i, {{std::sin(0.1 * i) * 300.0, 7.0 * i, 900.0 - i},
                                               Angle::from_degrees(3.0 * i),
                                               Angle::from_degrees(-0.5 * i)});
    recording.add(kHeadlessFrameTime * 49, {});  // a time again: not taken
    REQUIRE(recording.path().samples.size() == 50);
    const auto path = platform::resolve(recording.path(), no_ground, {.frame_interval = kHeadlessFrameTime});
    REQUIRE(path);
    for (int i = 0; i < 50; ++i) {
        const auto& sample = recording.path().samples[static_cast<std::size_t>(i)].pose;
        CHECK(glm::length(path->frame(static_cast<std::size_t>(i)).eye_m - sample.eye_m) < 1e-6);
    }
}

TEST_CASE("The sun is where the almanac has it") {
    using namespace std::chrono;
    // Greenwich at noon of the June solstice: nearly due south, 90 - 51.48 + 23.44 degrees up.
    const auto greenwich = daylight_at(sys_days(2026y / June / 21) + 12h + 2min, {0.0, 51.48});
    CHECK(greenwich.sun_elevation.degrees() == doctest::Approx(61.96).epsilon(0.002));
    CHECK(std::abs(std::remainder(greenwich.sun_azimuth.degrees() - 180.0, 360.0)) < 0.5);
    // On the equator at an equinox, at six in the morning local time, it rises due east.
    const auto equator = daylight_at(sys_days(2026y / March / 20) + 6h + 7min, {0.0, 0.0});
    CHECK(std::abs(equator.sun_elevation.degrees()) < 0.6);
    CHECK(equator.sun_azimuth.degrees() == doctest::Approx(90.0).epsilon(0.01));
    // Southern winter, afternoon in Sydney: low in the north-west.
    const auto sydney = daylight_at(sys_days(2026y / June / 21) + 5h, {151.2, -33.87});
    CHECK(sydney.sun_elevation.degrees() > 10.0);
    CHECK(sydney.sun_elevation.degrees() < 30.0);
    CHECK(std::remainder(sydney.sun_azimuth.degrees(), 360.0) < -20.0);
}

TEST_CASE("Places in degrees are right over whole continents and at the date line") {
    io::TerrainInfo info;
    info.crs_wkt = "EPSG:3857";
    const PlaceNames mercator(info);
    constexpr double kRadius_m = 6378137.0, kDegree = 3.14159265358979323846 / 180.0;
    for (double longitude = -179.5; longitude < 180.0; longitude += 7.3)
        for (double latitude = -80.0; latitude <= 80.0; latitude += 8.7) {
            // Web Mercator's own formulas.
            const double north = std::log(std::tan((45.0 + latitude / 2.0) * kDegree));
            const auto found = mercator.degrees(kRadius_m * glm::dvec2(longitude * kDegree, north));
            REQUIRE(found);
            CHECK(found->x == doctest::Approx(longitude).epsilon(1e-9));
            CHECK(found->y == doctest::Approx(latitude).epsilon(1e-9));
        }
    CHECK(!PlaceNames(io::TerrainInfo{}).degrees({0.0, 0.0}));
}

TEST_CASE("A curve holds the newest values, in order") {
    Curve curve;
    for (int i = 0; i < 1000; ++i) curve.add(static_cast<float>(i));
    CHECK(curve.newest() == 999.0f);
    CHECK(curve.at(0) == static_cast<float>(1000 - Curve::kLength));
    CHECK(curve.at(Curve::kLength - 1) == 999.0f);
    CHECK(curve.largest() == 999.0f);
}

TEST_CASE(
    "imagery is asked for with its ancestors, each once and before its descendants, as much as there are "
    "slots") {
    const io::Grid chunks(257, 257, 32), imagery(5001, 3001, 256);
    const pager::TileSpace tiles(chunks, imagery);
    std::mt19937 random(5);
    for (int trial = 0; trial < 200; ++trial) {
        const std::size_t slots = 1 + random() % 400;
        app::TileWants wants(tiles, pager::TileKind::imagery, slots);
        std::vector<select::ScheduledTile> chosen;
        for (std::int64_t i = imagery.first(1); i < imagery.node_count(); ++i)
            if (random() % 4 == 0)
                chosen.push_back({imagery.node_at(i), static_cast<std::uint32_t>(i), 0.0f});
        wants.gather(chosen);
        std::set<pager::NodeIndex> before;
        for (const pager::NodeIndex tile : wants.tiles()) {
            REQUIRE(tiles.kind(tile) == pager::TileKind::imagery);
            const io::NodeId node = tiles.id(tile);
            if (node.level > 0)
                REQUIRE(before.contains(tiles.index(pager::TileKind::imagery, node.parent())));
            REQUIRE(before.insert(tile).second);
        }
        std::set<pager::NodeIndex> all;
        for (const select::ScheduledTile& tile : chosen)
            for (io::NodeId node = tile.node;; node = node.parent()) {
                all.insert(tiles.index(pager::TileKind::imagery, node));
                if (node.level == 0) break;
            }
        CHECK(before.size() == std::min(all.size(), slots + static_cast<std::size_t>(imagery.first(1))));
    }
}

TEST_CASE(
    "where cells draw, tiles are asked for on which they stand and into which they look, and no others") {
    const io::Grid grid(257, 200, 32);
    const pager::TileSpace tiles(grid, {}, grid);
    std::mt19937 random(6);
    for (int trial = 0; trial < 100; ++trial) {
        std::vector<io::NodeRecord> records(static_cast<std::size_t>(grid.node_count()));
        for (io::NodeRecord& record : records)
            if (random() % 8 != 0) record.flags = io::NodeRecord::kHasData;
        std::vector<select::NearNode> cells;
        std::set<pager::NodeIndex> expected;
        const auto expect = [&](io::NodeId node) {
            for (;; node = node.parent()) {
                expected.insert(tiles.index(pager::TileKind::heights, node));
                if (node.level == 0) break;
            }
        };
        for (std::int64_t i = grid.first(grid.finest()); i < grid.node_count(); ++i) {
            const io::NodeId node = grid.node_at(i);
            if (random() % 5 != 0 || !records[static_cast<std::size_t>(i)].has_data()) continue;
            cells.push_back({node});
            for (const int corner : {0, 1, 2, 3}) {
                const io::NodeId at{node.level, node.x + corner % 2, node.y + corner / 2};
                if (grid.contains(at) && records[static_cast<std::size_t>(grid.linear(at))].has_data())
                    expect(at);
            }
        }
        app::TileWants wants(tiles, pager::TileKind::heights, 1000);
        wants.gather({}, cells, records);
        CHECK(std::set<pager::NodeIndex>(wants.tiles().begin(), wants.tiles().end()) == expected);
        CHECK(wants.tiles().size() == expected.size());
        CHECK(wants.chosen().empty());
        // With little room: all that was chosen, then of what cells need as much as there is room for.
        const std::vector<select::ScheduledTile> chosen = {{grid.node_at(grid.node_count() - 1), 0, 0.0f}};
        app::TileWants few(tiles, pager::TileKind::heights, 20);
        few.gather(chosen, cells, records);
        expect(chosen[0].node);
        CHECK(few.tiles().size() == std::min(expected.size(), 20 + static_cast<std::size_t>(grid.first(1))));
        CHECK(few.chosen().size() == static_cast<std::size_t>(grid.levels()));
        CHECK(few.chosen().back() == tiles.index(pager::TileKind::heights, chosen[0].node));
        CHECK(few.chosen().size() + few.beside().size() == few.tiles().size());
        std::set<pager::NodeIndex> before;
        for (const pager::NodeIndex tile : few.tiles()) {
            const io::NodeId node = tiles.id(tile);
            REQUIRE(
                (node.level == 0 || before.contains(tiles.index(pager::TileKind::heights, node.parent()))));
            before.insert(tile);
        }
    }
}

TEST_CASE("F6 goes from the mesh to the disc, to the quadtree, and back") {
    WalkSettings settings;
    CHECK(settings.surface == render::Surface::mesh);
    apply_keys(pressing(Key::f6), settings);
    CHECK(settings.surface == render::Surface::disc);
    apply_keys(pressing(Key::f6), settings);
    CHECK(settings.surface == render::Surface::quadtree);
    apply_keys(pressing(Key::f6), settings);
    CHECK(settings.surface == render::Surface::mesh);
}

TEST_CASE("I goes from imagery to tint and back") {
    WalkSettings settings;
    CHECK(settings.cover == render::Cover::imagery);
    apply_keys(pressing(Key::i), settings);
    CHECK(settings.cover == render::Cover::tint);
    apply_keys(pressing(Key::i), settings);
    CHECK(settings.cover == render::Cover::imagery);
}
