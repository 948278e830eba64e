// Ray casts and lines of sight against exact arithmetic over every cell under the ray (support/exact_ray.h).
// 10 000 rays of each over random land and 500 over Taiwan where it lies; with RIDGELINE_LONG=1 1 000 000 and
// 10 000. And over what is made below them, a tenth as many.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <utility>

#include "ridgeline/detail/detail_tile.h"
#include "ridgeline/detail/finer_ground.h"
#include "ridgeline/select/surface_query.h"
#include "support/built_store.h"
#include "support/data.h"
#include "support/exact_ray.h"
#include "support/small_store.h"
#include "unit/app_folder.h"
#include "unit/stored_scene.h"

namespace ridgeline::test {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
// Nearer to the surface than this, touching it and passing it are the same; so are ending before it and on it.
constexpr double kTouch_m = 1e-6;
constexpr double kGraze_m = 1e-3;

// What doubles cannot tell of where a cell ends, in its sides.
constexpr double kRim = 1e-9;

int rays_to_try() { return std::getenv("RIDGELINE_LONG") ? 1'000'000 : 10'000; }

SampledGround ground_of(const StoredScene& stored) {
    const io::TerrainInfo& info = stored.scene.info();
    return {&info, [&](std::int64_t x, std::int64_t y) {
                return stored.valid(x, y) ? std::optional(info.height_m(stored.scene.quanta(x, y)))
                                          : std::nullopt;
            }};
}

// Kinds of rays: most anyhow, the rest where arithmetic is hardest.
class RandomRays {
  public:
    RandomRays(const SampledGround& ground, std::uint64_t seed)
        : ground_(ground), info_(*ground.info), random_(seed) {}

    // Two places of a line, from near the ground or far from it, inside the terrain or beside it.
    std::pair<glm::dvec3, glm::dvec3> next() {
        const int kind = whole(random_, 0, 9);
        if (kind == 8) return through_ground();
        glm::dvec2 a = place(), b = place();
        double low_m = height_m(), high_m = height_m();
        if (kind == 0) b = a;                        // vertical
        if (kind == 1) b.x = a.x = std::round(a.x);  // along a column of samples
        if (kind == 2) b.y = a.y = std::round(a.y);  // along a row
        if (kind == 3) b = (a = glm::round(a)) + double(whole(random_, -40, 40)) * glm::dvec2(1.0, -1.0);
        if (kind == 4) a = glm::round(a), b = glm::round(b);  // through samples
        if (kind == 5) low_m = high_m = std::round(low_m / info_.quantum_m) * info_.quantum_m;  // level
        if (kind == 6) b.x = (a.x = border(info_.width)) + uniform(random_, -1e-11, 1e-11);  // along a border
        if (kind == 7) b = glm::dvec2(border(info_.width), border(info_.height));  // to a corner of tiles
        return {at(a, low_m), at(b, high_m)};
    }

  private:
    // Into the ground, or out of it, right where cells meet, and at small angles too.
    std::pair<glm::dvec3, glm::dvec3> through_ground() {
        const auto x = whole(random_, 0, static_cast<int>(info_.width - 1));
        const auto y = whole(random_, 0, static_cast<int>(info_.height - 1));
        const glm::dvec3 sample = at({x, y}, ground_.height_m(x, y).value_or(0.0));
        const double steep = std::exp(uniform(random_, -14.0, 1.0));
        const glm::dvec3 aside(uniform(random_, -900.0, 900.0), uniform(random_, -900.0, 900.0),
                               uniform(random_, -900.0, 900.0) * steep);
        return {sample - aside, sample + aside};
    }
    glm::dvec3 at(const glm::dvec2& lattice, double height_m) const {
        return {info_.world(lattice.x, lattice.y), height_m};
    }
    glm::dvec2 place() {
        const double aside = whole(random_, 0, 4) == 0 ? 30.0 : 0.0;
        return {uniform(random_, -aside, static_cast<double>(info_.width - 1) + aside),
                uniform(random_, -aside, static_cast<double>(info_.height - 1) + aside)};
    }
    double border(std::int64_t samples) {
        const int quads = info_.tile - 1;
        return quads * whole(random_, 0, static_cast<int>((samples - 1) / quads));
    }
    double height_m() {
        const double range_m = info_.max_height_m - info_.min_height_m + 1.0;
        return info_.min_height_m + uniform(random_, -0.2, 1.3) * range_m;
    }

    const SampledGround& ground_;
    const io::TerrainInfo& info_;
    Random random_;
};

struct Line {
    glm::dvec3 from_m, to_m;
    double length_m() const { return glm::distance(from_m, to_m); }
    glm::dvec3 unit() const {
        return length_m() > 0.0 ? glm::normalize(to_m - from_m) : glm::dvec3(0.0, 0.0, -1.0);
    }
    ExactRay certain(const SampledGround& ground) const {
        return {ground, from_m, unit(), length_m() + kTouch_m, 0.0};
    }
    ExactRay possible(const SampledGround& ground) const {
        return {ground, from_m, unit(), length_m() + kTouch_m, kRim};
    }
};

void check_cast(select::SurfaceQuery& query, const SampledGround& ground, const Line& line, int& hits) {
    const auto cast = query.ray_cast(line.from_m, line.unit(), line.length_m());
    REQUIRE(cast.ok());
    const auto crossed_m = static_cast<double>(line.certain(ground).crossed_m(kTouch_m));
    if (!cast->hit) {
        REQUIRE(crossed_m > line.length_m() - kTouch_m);
        return;
    }
    ++hits;
    REQUIRE(cast->distance_m <= crossed_m + kTouch_m);
    REQUIRE(std::abs(static_cast<double>(line.possible(ground).over_m(cast->distance_m))) <= kTouch_m);
    REQUIRE(glm::distance(line.from_m + cast->distance_m * line.unit(), cast->point_m) < kTouch_m);
}

void check_sight(select::SurfaceQuery& query, const SampledGround& ground, const Line& line, int& hidden) {
    const auto sight = query.line_of_sight(line.from_m, line.to_m);
    REQUIRE(sight.ok());
    REQUIRE(sight->clear != sight->hidden_by.hit);
    const auto under_m = static_cast<double>(line.certain(ground).under_m(kGraze_m + kTouch_m, kTouch_m));
    if (sight->clear) {
        REQUIRE(under_m > line.length_m() - kTouch_m);
        return;
    }
    ++hidden;
    REQUIRE(sight->hidden_by.distance_m <= under_m + kTouch_m);
    const auto may_be_m = static_cast<double>(line.possible(ground).under_m(kGraze_m - kTouch_m, 0.0));
    REQUIRE(may_be_m <= sight->hidden_by.distance_m + kTouch_m);
}

// Every sample of the ground that is made below a store, by the rules of a tile and its children alone.
class MadeSamples {
  public:
    MadeSamples(const io::Store& store, int octaves)
        : store_(store), octaves_(octaves), info_(detail::finer_lattice(store.info(), octaves)) {}

    SampledGround ground() const {
        return {&info_, [this](std::int64_t x, std::int64_t y) { return height_m(x, y); }};
    }

  private:
    struct Made {
        io::HeightsTile source;
        detail::DetailTile tile;
    };

    // Of a node with data that has the sample; samples are valid between valid ones.
    std::optional<double> height_m(std::int64_t x, std::int64_t y) const {
        const int quads = store_.grid().quads();
        for (const std::int64_t row : {y / quads, (y - 1) / quads})
            for (const std::int64_t column : {x / quads, (x - 1) / quads}) {
                const Made* made = find(static_cast<std::int32_t>(column), static_cast<std::int32_t>(row));
                if (made == nullptr) continue;
                if (!is_valid(made->source, x, y)) return {};
                const auto in_x = static_cast<int>(x - column * quads);
                const auto in_y = static_cast<int>(y - row * quads);
                return store_.info().height_m(
                    std::ldexp(made->tile.height(in_x, in_y), -detail::detail_shift(store_.info())));
            }
        return {};
    }
    bool is_valid(const io::HeightsTile& source, std::int64_t x, std::int64_t y) const {
        const std::int64_t rate = std::int64_t{1} << octaves_, side = source.quads * rate;
        if (source.all_valid) return true;
        for (const std::int64_t above : {y / rate, (y + rate - 1) / rate})
            for (const std::int64_t beside : {x / rate, (x + rate - 1) / rate}) {
                const auto column = static_cast<int>(beside - x / side * source.quads);
                const auto row = static_cast<int>(above - y / side * source.quads);
                if (source.sample_valid[source.at(column, row)] == 0) return false;
            }
        return true;
    }
    const Made* find(std::int32_t column, std::int32_t row) const {
        const io::NodeId source{store_.grid().finest(), column >> octaves_, row >> octaves_};
        if (!store_.grid().contains(source) || !store_.record(source).has_data()) return nullptr;
        const auto [at, is_new] = made_.try_emplace({column, row});
        if (is_new) make(source, column, row, at->second);
        return &at->second;
    }
    void make(io::NodeId source, std::int32_t column, std::int32_t row, Made& made) const {
        std::vector<std::uint8_t> bytes;
        REQUIRE(store_.read_heights(source, bytes, made.source).ok());
        detail::make_root(made.source, source, detail::detail_shift(store_.info()), made.tile);
        for (int below = octaves_ - 1; below >= 0; --below) {
            const int quarter = (column >> below & 1) + 2 * (row >> below & 1);
            const detail::DetailTile parent = made.tile;
            detail::make_child(parent, quarter,
                               store_.info().detail->octaves[static_cast<std::size_t>(parent.octave)],
                               made.tile);
        }
    }

    const io::Store& store_;
    int octaves_;
    io::TerrainInfo info_;
    mutable std::map<std::pair<std::int32_t, std::int32_t>, Made> made_;
};

// Rays over some lands, of which one is all but flat, some have holes, and some several roots.
template <class Check>
void check_lands(std::uint64_t seed, int octaves, const Check& check) {
    const int all_rays = octaves > 0 ? rays_to_try() / 10 : rays_to_try();
    const struct {
        SceneShape shape;
        double invalid_share;
    } lands[] = {{{300, 180, 32, 1}, 0.0},
                 {{300, 180, 32, 2, 0.3}, 0.02},
                 {{66, 400, 32, 3}, 0.3},
                 {{200, 65, 64, 4, 0.2}, 0.0},
                 {.shape = {.width = 130, .height = 130, .seed = 5, .relief = 0.0}, .invalid_share = 0.05}};
    int met = 0;
    for (const auto& land : lands) {
        const StoredScene stored(land.shape, land.invalid_share);
        const io::Store store = stored.open();
        select::SurfaceQuery query(store, {.detail_levels = octaves});
        const MadeSamples made(store, octaves);
        const SampledGround ground = octaves > 0 ? made.ground() : ground_of(stored);
        RandomRays rays(ground, seed + land.shape.seed);
        for (int i = 0; i < all_rays / static_cast<int>(std::size(lands)); ++i) {
            const auto [from_m, to_m] = rays.next();
            CAPTURE(land.shape.seed);
            CAPTURE(i);
            check(query, ground, Line{from_m, to_m}, met);
        }
    }
    CHECK(met > all_rays / 4);
    CHECK(met < all_rays);
}

// Every sample of a store's finest tiles.
class StoreSamples {
  public:
    explicit StoreSamples(const io::Store& store) : info_(store.info()) {
        const io::Grid& grid = store.grid();
        const auto samples = static_cast<std::size_t>(grid.width() * grid.height());
        quanta_.resize(samples);
        valid_.resize(samples);
        std::vector<std::uint8_t> bytes;
        io::HeightsTile tile;
        for (std::int64_t i = grid.first(grid.finest()); i < grid.node_count(); ++i) {
            const io::NodeId node = grid.node_at(i);
            if (!store.record(node).has_data()) continue;
            REQUIRE(store.read_heights(node, bytes, tile).ok());
            copy(tile, grid.origin(node));
        }
    }
    SampledGround ground() const {
        return {&info_, [this](std::int64_t x, std::int64_t y) {
                    return valid_[at(x, y)] ? std::optional(info_.height_m(quanta_[at(x, y)])) : std::nullopt;
                }};
    }

  private:
    std::size_t at(std::int64_t x, std::int64_t y) const {
        return static_cast<std::size_t>(y * info_.width + x);
    }
    void copy(const io::HeightsTile& tile, const io::LatticePoint& origin) {
        for (int row = 0; row <= tile.quads && origin.y + row < info_.height; ++row)
            for (int column = 0; column <= tile.quads && origin.x + column < info_.width; ++column) {
                const std::size_t from = tile.at(column, row), to = at(origin.x + column, origin.y + row);
                quanta_[to] = tile.quanta[from];
                valid_[to] = tile.all_valid || tile.sample_valid[from] != 0;
            }
    }

    const io::TerrainInfo& info_;
    std::vector<std::int32_t> quanta_;
    std::vector<bool> valid_;
};

// A plain at 100 m, with a ridge of 150 m along column 64.
class RidgeLand {
    const ReferenceTerrain terrain_{io::Grid(129, 97, 32),
                                    [](std::int64_t x, std::int64_t) { return x == 64 ? 150 : 100; }};
    const SmallStore folder_{terrain_};

  public:
    const io::Store store = io::Store::open(folder_.directory()).value();
    // column, row and height.
    glm::dvec3 at(const glm::dvec3& place) const { return {store.info().world(place.x, place.y), place.z}; }
};

glm::dvec3 over(const io::TerrainInfo& info, double column, double row, double height_m) {
    return {info.world(column, row), height_m};
}

constexpr glm::dvec3 kDown(0.0, 0.0, -1.0), kUp(0.0, 0.0, 1.0), kEast(1.0, 0.0, 0.0);

}  // namespace

void check_real_land(select::SurfaceQuery& query, const SampledGround& ground, std::uint64_t seed, int rays) {
    RandomRays random(ground, seed);
    int hits = 0, hidden = 0;
    for (int i = 0; i < rays; ++i) {
        const auto [from_m, to_m] = random.next();
        CAPTURE(i);
        check_cast(query, ground, Line{from_m, to_m}, hits);
        check_sight(query, ground, Line{from_m, to_m}, hidden);
    }
    CHECK(hits > rays / 5);
    CHECK(hidden > rays / 5);
}

TEST_CASE("ray casts end where exact arithmetic over every cell ends them") {
    check_lands(10, 0, check_cast);
}

TEST_CASE("lines of sight are clear where exact arithmetic finds no ground over them") {
    check_lands(20, 0, check_sight);
}

TEST_CASE("rays over made ground end where exact arithmetic over every one of its cells ends them") {
    check_lands(40, 1, check_cast);
    check_lands(50, 3, check_cast);
    check_lands(60, 2, check_sight);
}

TEST_CASE("ray casts and lines of sight over real land are what exact arithmetic says") {
    // The larger one takes a while to build.
    const bool is_long = std::getenv("RIDGELINE_LONG") != nullptr;
    const auto source = data_file(is_long ? "taiwan_central_8k.tif" : "taiwan_2k.tif");
    if (source.empty()) return;
    const Folder folder;
    const io::Store store = built_store(source.string(), folder.path() / "taiwan.terrain");
    const StoreSamples samples(store);
    const SampledGround ground = samples.ground();
    select::SurfaceQuery query(store);
    check_real_land(query, ground, 30, is_long ? 10000 : 500);
    const MadeSamples made(store, 3);
    const SampledGround finer = made.ground();
    select::SurfaceQuery below(store, {.detail_levels = 3});
    // A kilometre or so, within one part of it: the reference keeps every tile that it looks at.
    Random random(31);
    int hits = 0, hidden = 0;
    for (int i = 0; i < (is_long ? 4000 : 400); ++i) {
        const double column = uniform(random, 600.0, 700.0), row = uniform(random, 900.0, 1000.0);
        const auto under = query.height_at(column, row);
        REQUIRE(under.ok());
        const glm::dvec3 from_m =
            over(store.info(), column, row, under->height_m + uniform(random, 0.0, 60.0));
        const Line line{from_m,
                        from_m + glm::dvec3(uniform(random, -900.0, 900.0), uniform(random, -900.0, 900.0),
                                            uniform(random, -300.0, 150.0))};
        CAPTURE(i);
        check_cast(below, finer, line, hits);
        check_sight(below, finer, line, hidden);
    }
    CHECK(hits > 100);
    CHECK(hidden > 100);
}

TEST_CASE("a vertical ray hits the height that is answered there, from above and below, on samples too") {
    const StoredScene stored({300, 180, 32, 2, 0.3}, 0.05);
    const io::Store store = stored.open();
    int octaves = 0;
    SUBCASE("the source's ground") {}
    SUBCASE("made ground") { octaves = 3; }
    select::SurfaceQuery query(store, {.detail_levels = octaves});
    Random random(1);
    int grounds = 0;
    for (int i = 0; i < 20000; ++i) {
        double column = uniform(random, 0.0, 299.0), row = uniform(random, 0.0, 179.0);
        if (whole(random, 0, 1) == 0) column = std::round(column);
        if (whole(random, 0, 1) == 0) row = std::round(row);
        const glm::dvec3 place = over(store.info(), column, row, 0.0);
        const auto height = query.height(place.x, place.y);
        REQUIRE(height.ok());
        const bool ground = height->kind == select::SurfaceHeight::Kind::ground;
        grounds += ground ? 1 : 0;
        for (const double from_m : {9000.0, -9000.0}) {
            const auto cast = query.ray_cast(place + from_m * kUp, from_m > 0.0 ? kDown : kUp, kInfinite);
            REQUIRE(cast.ok());
            REQUIRE(cast->hit == ground);
            if (ground) REQUIRE(std::abs(cast->point_m.z - height->height_m) < kTouch_m);
        }
    }
    CHECK(grounds > 5000);
    CHECK(grounds < 19000);
}

TEST_CASE("what begins far away hits as exactly as what begins near by") {
    const StoredScene stored({300, 180, 32, 1}, 0.0);
    const io::Store store = stored.open();
    select::SurfaceQuery query(store);
    const SampledGround ground = ground_of(stored);
    RandomRays rays(ground, 3);
    int hits = 0;
    for (int i = 0; i < 3000; ++i) {
        const auto [a_m, b_m] = rays.next();
        const Line near{a_m, b_m};
        const glm::dvec3 far_m = near.from_m - 1e8 * near.unit();
        const auto hit = query.ray_cast(far_m, near.unit(), kInfinite);
        REQUIRE(hit.ok());
        if (!hit->hit) continue;
        ++hits;
        const glm::dvec2 place = store.info().lattice(hit->point_m.x, hit->point_m.y);
        const auto height = query.height_at(place.x, place.y);
        // At the raster's edge rounding may take the place out of it.
        if (height->kind != select::SurfaceHeight::Kind::ground) continue;
        REQUIRE(std::abs(height->height_m - hit->point_m.z) < 1e-5);
    }
    CHECK(hits > 1000);
}

TEST_CASE("lines of sight: over a ridge, into it, along the ground, and under it") {
    const RidgeLand land;
    select::SurfaceQuery query(land.store);
    const auto sight = [&](const glm::dvec3& from, const glm::dvec3& to) {
        const auto result = query.line_of_sight(land.at(from), land.at(to));
        REQUIRE(result.ok());
        return *result;
    };
    CHECK(sight({3.5, 20.0, 151.0}, {120.0, 30.0, 151.0}).clear);
    CHECK(sight({64.0, 20.0, 150.0}, {120.0, 30.0, 100.0}).clear);  // from the ridge to its foot
    CHECK(sight({3.5, 20.0, 100.0}, {60.0, 90.5, 100.0}).clear);    // ground does not hide itself
    CHECK(sight({3.5, 20.0, 100.0}, {3.5, 20.0, 100.0}).clear);
    CHECK(!sight({3.5, 20.0, 99.0}, {3.5, 20.0, 99.0}).clear);
    CHECK(!sight({3.5, 20.0, 102.0}, {40.0, 20.0, 99.9}).clear);
    CHECK(!sight({3.5, 20.0, 99.9}, {40.0, 20.0, 102.0}).clear);
    CHECK(!sight({3.5, 20.0, 90.0}, {40.0, 20.0, 90.0}).clear);
    const auto hidden = sight({14.0, 20.0, 125.0}, {120.0, 20.0, 125.0});
    CHECK(!hidden.clear);
    CHECK(hidden.hidden_by.distance_m == doctest::Approx(49.5).epsilon(1e-5));
    CHECK(glm::distance(hidden.hidden_by.point_m, land.at({63.5, 20.0, 125.0})) < 1e-3);
}

TEST_CASE("a ray that begins on the surface hits at once, one of no reach or beside the terrain never") {
    const RidgeLand land;
    select::SurfaceQuery query(land.store);
    const auto cast = [&](const glm::dvec3& from, const glm::dvec3& direction, double reach_m) {
        const auto result = query.ray_cast(land.at(from), direction, reach_m);
        REQUIRE(result.ok());
        return *result;
    };
    CHECK(cast({40.0, 40.0, 100.0}, kEast + kUp, 10.0).hit);
    CHECK(cast({40.0, 40.0, 100.0}, kEast + kUp, 10.0).distance_m == 0.0);
    CHECK(cast({40.0, 40.0, 101.0}, kDown, 1.0).hit);
    CHECK(!cast({40.0, 40.0, 101.0}, kDown, 0.999).hit);
    CHECK(!cast({40.0, 40.0, 101.0}, kDown, -1.0).hit);
    CHECK(!cast({40.0, 40.0, 101.0}, kDown, std::numeric_limits<double>::quiet_NaN()).hit);
    CHECK(!cast({-1.0, 40.0, 9000.0}, kDown, kInfinite).hit);
    CHECK(!cast({128.5, 40.0, 9000.0}, kDown, kInfinite).hit);
    CHECK(cast({128.0, 96.0, 9000.0}, kDown, kInfinite).hit);
    CHECK(cast({40.0, 40.0, 9000.0}, 1e-300 * kDown, kInfinite).hit);
    // Under ground, looking up and along.
    CHECK(cast({40.0, 40.0, 90.0}, kUp, kInfinite).distance_m == doctest::Approx(10.0));
    CHECK(!cast({40.0, 40.0, 90.0}, kEast, kInfinite).hit);
    CHECK(cast({40.0, 40.0, 125.0}, kEast, kInfinite).distance_m == doctest::Approx(23.5));
}

TEST_CASE("a ray that means nothing is an error") {
    const StoredScene stored({66, 34, 32, 5}, 0.0);
    const io::Store store = stored.open();
    select::SurfaceQuery query(store);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK(!query.ray_cast(kUp, glm::dvec3(0.0), 1.0).ok());
    CHECK(!query.ray_cast({nan, 0.0, 0.0}, kDown, 1.0).ok());
    CHECK(!query.ray_cast(kUp, {0.0, kInfinite, 0.0}, 1.0).ok());
    CHECK(!query.line_of_sight(kUp, {kInfinite, 0.0, 0.0}).ok());
    CHECK(query.ray_cast(kUp, glm::dvec3(0.0), 1.0).error().message.starts_with("ray: "));
}

}  // namespace ridgeline::test
