// Heights, ray casts and standing places asked of a store on disk, against references that look at every
// sample.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

#include "ridgeline/select/surface_query.h"
#include "unit/stored_scene.h"

namespace ridgeline::test {
namespace {

using Kind = select::SurfaceHeight::Kind;

// A height of the scene's ground at a place, or the fill where it is invalid.
double height_m(const Scene& scene, double column, double row) {
    const auto x = static_cast<std::int64_t>(column), y = static_cast<std::int64_t>(row);
    const double u = column - static_cast<double>(x), v = row - static_cast<double>(y);
    const double north = scene.quanta(x, y) * (1 - u) + scene.quanta(x + 1, y) * u;
    const double south = scene.quanta(x, y + 1) * (1 - u) + scene.quanta(x + 1, y + 1) * u;
    return scene.info().height_m(north * (1 - v) + south * v);
}

// The first change of side along a ray in steps of `step_m`; infinite without one. Holes have no side.
double first_crossing(const StoredScene& stored, const glm::dvec3& origin, const glm::dvec3& unit,
                      double length_m, double step_m) {
    const auto& info = stored.scene.info();
    double last_over = 0.0;
    for (double d = 0.0; d <= length_m; d += step_m) {
        const glm::dvec3 p = origin + d * unit;
        const glm::dvec2 place = info.lattice(p.x, p.y);
        const bool inside = place.x >= 0 && place.y >= 0 && place.x <= static_cast<double>(info.width - 1) &&
                            place.y <= static_cast<double>(info.height - 1);
        const auto ground = inside ? stored.reference(place.x, place.y) : std::nullopt;
        const double over = ground ? p.z - *ground : 0.0;
        if (last_over * over < 0.0) return d;
        last_over = over;
    }
    return std::numeric_limits<double>::infinity();
}

}  // namespace

TEST_CASE("heights are the samples' at samples and bilinear between; only what has weight matters") {
    const StoredScene stored({300, 180, 32, 1}, 0.05);
    const io::Store store = stored.open();
    select::SurfaceQuery query(store, {.cached_tiles = 4});
    Random random(1);
    int grounds = 0, holes = 0;
    for (int i = 0; i < 20000; ++i) {
        double column = uniform(random, 0.0, 299.0), row = uniform(random, 0.0, 179.0);
        if (whole(random, 0, 2) == 0) column = std::round(column);
        if (whole(random, 0, 2) == 0) row = std::round(row);
        const auto expected = stored.reference(column, row);
        const glm::dvec2 world = store.info().world(column, row);
        const auto found = query.height(world.x, world.y);
        REQUIRE(found.ok());
        REQUIRE((found->kind == Kind::ground) == expected.has_value());
        if (expected) CHECK(found->height_m == doctest::Approx(*expected).epsilon(1e-9));
        expected ? ++grounds : ++holes;
    }
    CHECK(grounds > 10000);
    CHECK(holes > 500);
}

TEST_CASE("beyond the outermost samples is outside, on them is not") {
    const StoredScene stored({66, 34, 32, 5}, 0.0);
    const io::Store store = stored.open();
    select::SurfaceQuery query(store);
    const auto kind = [&](double column, double row) { return query.height_at(column, row)->kind; };
    CHECK(kind(0.0, 0.0) == Kind::ground);
    CHECK(kind(65.0, 33.0) == Kind::ground);
    CHECK(kind(65.01, 33.0) == Kind::outside);
    CHECK(kind(-0.01, 3.0) == Kind::outside);
    CHECK(kind(3.0, 33.5) == Kind::outside);
    CHECK(kind(std::numeric_limits<double>::quiet_NaN(), 3.0) == Kind::outside);
}

TEST_CASE("a ray cast ends on the surface, and nothing is crossed before") {
    const StoredScene stored({300, 180, 32, 1}, 0.02);
    const io::Store store = stored.open();
    select::SurfaceQuery query(store);
    const auto& info = store.info();
    Random random(2);
    int hits = 0, misses = 0;
    for (int i = 0; i < 600; ++i) {
        const auto place = [&] {
            const double x = uniform(random, 0.0, 298.9), y = uniform(random, 0.0, 178.9);
            return glm::dvec3(info.world(x, y), height_m(stored.scene, x, y));
        };
        const glm::dvec3 origin = place() + glm::dvec3(0.0, 0.0, std::exp(uniform(random, 0.0, 7.0)));
        glm::dvec3 direction = place() - origin;
        if (whole(random, 0, 9) == 0) direction = {0.0, 0.0, -1.0};
        if (whole(random, 0, 9) == 0) direction = {0.0, whole(random, 0, 1) == 0 ? 1.0 : -1.0, -0.05};
        const glm::dvec3 unit = glm::normalize(direction);
        const double reach_m = 20000.0;
        const auto hit = query.ray_cast(origin, direction, reach_m);
        REQUIRE(hit.ok());
        const double step_m = 0.5;
        const double crossing = first_crossing(stored, origin, unit, reach_m, step_m);
        if (!hit->hit) {
            CHECK(crossing == std::numeric_limits<double>::infinity());
            ++misses;
            continue;
        }
        ++hits;
        // A crossing out and back within a step escapes the reference, never the cast.
        CHECK(hit->distance_m <= crossing);
        const glm::dvec2 at = info.lattice(hit->point_m.x, hit->point_m.y);
        CHECK(hit->point_m.z == doctest::Approx(height_m(stored.scene, at.x, at.y)).epsilon(1e-7));
        CHECK(glm::distance(origin + hit->distance_m * unit, hit->point_m) < 1e-6);
        const auto shorter = query.ray_cast(origin, direction, hit->distance_m - 0.01);
        CHECK(!shorter->hit);
    }
    CHECK(hits > 400);
    CHECK(misses > 5);
}

TEST_CASE("the finest triangulation is the finest level's surface") {
    const StoredScene stored({300, 180, 32, 1}, 0.0);
    const io::Store store = stored.open();
    select::FinestSurface surface(store, {.cached_chunks = 2});
    Random random(3);
    for (int i = 0; i < 3000; ++i) {
        const int x = whole(random, 0, 299), y = whole(random, 0, 179);
        const auto found = surface.height_at(x, y);
        REQUIRE(found.ok());
        REQUIRE(found->has_value());
        const double quanta = stored.scene.surface(x, y, stored.scene.grid().finest());
        CHECK(**found == doctest::Approx(store.info().height_m(quanta)).epsilon(1e-9));
    }
    CHECK(!surface.height_at(-1.0, 5.0)->has_value());
    CHECK(!surface.height_at(5.0, 180.0)->has_value());
}

TEST_CASE("a damaged tile is an error that names the file") {
    const StoredScene stored({129, 129, 32, 2}, 0.0);
    const auto file = stored.path() / io::layer_file(io::Layer::heights);
    std::fstream bytes(file, std::ios::in | std::ios::out | std::ios::binary);
    const auto size = std::filesystem::file_size(file);
    for (std::uintmax_t i = 0; i < size; i += 7) {
        bytes.seekp(static_cast<std::streamoff>(i));
        bytes.put('x');
    }
    bytes.close();
    const io::Store store = stored.open();
    select::SurfaceQuery query(store);
    const auto found = query.height_at(5.0, 5.0);
    REQUIRE(!found.ok());
    CHECK(found.error().message.find("heights.tiles") != std::string::npos);
    CHECK(!query.ray_cast({store.info().world(5.0, 5.0), 5000.0}, {0.0, 0.0, -1.0}, 1e5).ok());
    select::FinestSurface surface(store);
    CHECK(!surface.height_at(5.0, 5.0).ok());
    // Nothing half read is kept.
    CHECK(!query.height_at(5.0, 5.0).ok());
}

}  // namespace ridgeline::test
