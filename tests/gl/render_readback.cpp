// What the GPU reads back of the ground, against places worked out in double precision: from the frame's own
// depth, and by casting rays.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "gl/render_scene.h"
#include "ridgeline/select/surface_query.h"
#include "support/ray_under_ground.h"

using namespace ridgeline;
using namespace ridgeline::test;
using select::GroundMask;
using select::GroundReadback;
using select::GroundRectangle;

namespace {

constexpr glm::ivec2 kSize(161, 121);
constexpr render::GroundSampling kSampling;

using Random = std::mt19937_64;
double uniform(Random& random, double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
}

// Folds along lattice lines only: every cell is a plane, so triangles and bilinear patches are the same.
std::int32_t folded_quanta(std::int64_t x, std::int64_t y) {
    const auto tent = [](std::int64_t at, std::int64_t period) { return std::abs(at % period - period / 2); };
    return static_cast<std::int32_t>(tent(x, 64) + tent(y + 20, 96) / 2 * 2 - tent(x + 40, 160));
}

SceneOptions scheduled_scene(const io::TerrainInfo* info, std::span<const io::NodeRecord> records) {
    SceneOptions options;
    options.quanta = folded_quanta;
    options.stage.frame.size_px = kSize;
    options.stage.wait = app::TileWait::settle;
    options.stage.pixel_error = 0.01;
    if (info) options.stage.scheduled = select::ScheduledTexture{select::heights_tree(*info, records), 40};
    return options;
}

// A scene whose heights are scheduled.
std::unique_ptr<RenderScene> open_scene(app::TileWait wait) {
    auto scene = std::make_unique<RenderScene>(scheduled_scene(nullptr, {}));
    auto options = scheduled_scene(&scene->info(), scene->store().records());
    options.stage.wait = wait;
    scene->open(options.stage);
    return scene;
}

// Over the ground, mostly; some beside it and some that see the sky alone.
app::StageMoment random_moment(const RenderScene& scene, std::uint64_t number, Random& random) {
    app::StageMoment moment;
    moment.number = number;
    moment.camera.lens.size_px = kSize;
    const double beyond = number % 4 == 0 ? 300.0 : 0.0;
    const double column = uniform(random, -beyond, 256.0 + beyond);
    const double row = uniform(random, -beyond, 256.0 + beyond);
    const double pitch = number % 5 == 0 ? uniform(random, 50.0, 89.0) : uniform(random, -89.0, 10.0);
    const double height = 100.0 * std::exp2(uniform(random, 0.0, 3.0));
    moment.camera.pose = {scene.place(column, row, height), Angle::from_degrees(uniform(random, 0.0, 360.0)),
                          Angle::from_degrees(pitch)};
    return moment;
}

GroundReadback nothing_seen(const GroundReadback& like) {
    GroundReadback seen{.frame = like.frame, .sight = like.sight, .rectangle = {}, .mask = {}};
    seen.mask.clear(like.mask.lattice(), glm::dvec2(like.sight.eye_m));
    return seen;
}

void add(GroundReadback& seen, const glm::dvec2& place) {
    seen.rectangle.add({place, place});
    seen.mask.mark(GroundRectangle{place, place});
}

// Every cell of `these` is a cell of `those` or beside one. Cells at a grid's border are not its own to
// judge: the next grid holds them and what lies about them.
int cells_beside(const GroundMask& these, const GroundMask& those) {
    GroundMask wide = those;
    wide.widen();
    int missing = 0;
    for (int grid = 0; grid < GroundMask::kGrids; ++grid)
        for (int y = 1; y + 1 < GroundMask::kSide; ++y) {
            const auto at = static_cast<std::size_t>(grid * GroundMask::kSide + y);
            constexpr std::uint64_t kInner = 0x7ffffffffffffffe;
            missing += std::popcount(these.words()[at] & ~wide.words()[at] & kInner);
        }
    return missing;
}

int cells(const GroundMask& mask) {
    int count = 0;
    for (const std::uint64_t word : mask.words()) count += std::popcount(word);
    return count;
}

// Each side of `inner` no more than a cell outside `outer`; the cell in which it lies.
void check_holds(const GroundRectangle& outer, const GroundRectangle& inner, const GroundReadback& frame) {
    if (inner.empty()) return;
    REQUIRE(!outer.empty());
    const glm::dvec2 eye(frame.sight.eye_m);
    const auto cell_m = [&](const glm::dvec2& corner) {
        return glm::max(glm::dvec2(frame.mask.lattice().cell_m), glm::abs(corner - eye) / 16.0);
    };
    CHECK(glm::all(glm::lessThanEqual(outer.min, inner.min + cell_m(inner.min))));
    CHECK(glm::all(glm::greaterThanEqual(outer.max, inner.max - cell_m(inner.max))));
}

std::vector<float> depth_of(const gl::Framebuffer& target) {
    std::vector<float> depth(static_cast<std::size_t>(kSize.x) * kSize.y);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target.id());
    glReadPixels(0, 0, kSize.x, kSize.y, GL_DEPTH_COMPONENT, GL_FLOAT, depth.data());
    return depth;
}

// Calls with each texel that the pass looks at, counted from the lower left.
template <class Visit>
void visit_samples(const Visit& visit) {
    for (int y = 0; y < kSize.y - 1 + kSampling.step_px.y; y += kSampling.step_px.y)
        for (int x = 0; x < kSize.x - 1 + kSampling.step_px.x; x += kSampling.step_px.x)
            visit(glm::ivec2(std::min(x, kSize.x - 1), std::min(y, kSize.y - 1)));
}

glm::dvec3 ray_of(const platform::Camera& camera, const glm::dvec2& texel) {
    return ray_through(camera, {texel.x, kSize.y - texel.y});
}

}  // namespace

TEST_CASE("Readback: rectangle and mask are what the frame's depth says, wherever the camera is") {
    GlContext gl;
    if (!gl) return;
    const auto scene = open_scene(app::TileWait::settle);
    Random random(1);
    int sky_only = 0, counted = 0;
    for (std::uint64_t number = 0; number < 60; ++number) {
        CAPTURE(number);
        const auto moment = random_moment(*scene, number, random);
        const auto report = scene->stage().show(moment);
        platform::Camera camera = moment.camera;
        camera.pose.eye_m.z += report.eye_lift_m;
        const auto depth = depth_of(scene->stage().target());
        const GroundReadback* got = scene->stage().seen_ground();
        REQUIRE(got);
        CHECK(got->frame == number);
        CHECK(got->sight.eye_m == camera.pose.eye_m);
        GroundReadback expected = nothing_seen(*got);
        visit_samples([&](const glm::ivec2& texel) {
            const double at = depth[static_cast<std::size_t>(texel.y) * kSize.x + texel.x];
            if (at == 0.0) return;
            const glm::dvec3 ray = ray_of(camera, glm::dvec2(texel) + 0.5);
            const double ahead = glm::dot(ray, platform::forward(camera.pose));
            add(expected, glm::dvec2(camera.pose.eye_m + ray * (camera.lens.near_m / at / ahead)));
        });
        check_holds(got->rectangle, expected.rectangle, *got);
        check_holds(expected.rectangle, got->rectangle, *got);
        CHECK(cells_beside(got->mask, expected.mask) == 0);
        CHECK(cells_beside(expected.mask, got->mask) == 0);
        sky_only += expected.rectangle.empty();
        counted += cells(expected.mask);
    }
    CHECK(sky_only >= 5);
    CHECK(counted > 5000);
}

TEST_CASE("Readback: rectangle and mask are what rays meet, to a cell") {
    GlContext gl;
    if (!gl) return;
    const auto scene = open_scene(app::TileWait::settle);
    select::SurfaceQuery surface(scene->store());
    Random random(2);
    int hits = 0;
    for (std::uint64_t number = 0; number < 30; ++number) {
        CAPTURE(number);
        const auto moment = random_moment(*scene, number, random);
        const auto report = scene->stage().show(moment);
        platform::Camera camera = moment.camera;
        camera.pose.eye_m.z += report.eye_lift_m;
        const GroundReadback* got = scene->stage().seen_ground();
        REQUIRE(got);
        // Rasterisers move edges by parts of a pixel: what any ray of a pixel meets may be seen, what all of
        // them meet must be.
        GroundReadback may = nothing_seen(*got), must = nothing_seen(*got);
        visit_samples([&](const glm::ivec2& texel) {
            std::array<std::optional<glm::dvec2>, 5> met;
            constexpr glm::dvec2 kAbout[5] = {{0, 0}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}};
            for (std::size_t i = 0; i < met.size(); ++i) {
                const glm::dvec3 ray = ray_of(camera, glm::dvec2(texel) + 0.5 + kAbout[i] / 64.0);
                const auto hit = surface.ray_cast(camera.pose.eye_m, ray, 1e6);
                REQUIRE(hit.ok());
                if (hit->hit) add(may, *(met[i] = glm::dvec2(hit->point_m)));
            }
            const bool all = std::all_of(met.begin(), met.end(), [&](const auto& place) {
                if (!place || !met[0]) return false;
                const double away_m = glm::distance(*met[0], glm::dvec2(camera.pose.eye_m));
                return glm::distance(*place, *met[0]) < away_m / 64.0;
            });
            if (all) add(must, *met[0]), ++hits;
        });
        CHECK(cells_beside(got->mask, may.mask) == 0);
        CHECK(cells_beside(must.mask, got->mask) == 0);
        check_holds(got->rectangle, must.rectangle, *got);
        check_holds(may.rectangle, got->rectangle, *got);
    }
    CHECK(hits > 5000);
}

TEST_CASE("Readback: frames never wait for it, and what they use is some frames old at most") {
    GlContext gl;
    if (!gl) return;
    const auto scene = open_scene(app::TileWait::never);
    Random random(3);
    auto moment = random_moment(*scene, 1, random);
    std::uint64_t oldest = 0, used = 0;
    for (std::uint64_t number = 1; number <= 120; ++number) {
        moment.number = number;
        moment.camera.pose.heading =
            moment.camera.pose.heading + Angle::from_degrees(number % 40 == 0 ? 150.0 : 0.3);
        moment.now = pager::Seconds(static_cast<double>(number) / 60.0);
        const auto report = scene->stage().show(moment);
        if (!report.readback_age) continue;
        ++used;
        CHECK(*report.readback_age > 0);
        oldest = std::max(oldest, *report.readback_age);
    }
    const auto counters = scene->stage().readback_counters();
    CHECK(counters.asked == 120);
    CHECK(counters.arrived + counters.refused + 4 >= counters.asked);
    CHECK(used > 100);
    // As many as the ring holds, and the one that is drawn.
    CHECK(oldest <= 5);
}

TEST_CASE("Readback: a frame that waits for its tiles schedules by its own ground") {
    GlContext gl;
    if (!gl) return;
    const auto scene = open_scene(app::TileWait::settle);
    Random random(4);
    std::size_t tiles = 0;
    for (std::uint64_t number = 1; number <= 20; ++number) {
        const auto moment = random_moment(*scene, number, random);
        const auto nodes = [&] {
            scene->stage().show(moment);
            std::vector<io::NodeId> found;
            for (const auto& tile : scene->stage().schedule()->tiles) found.push_back(tile.node);
            return found;
        };
        const auto first = nodes();
        CHECK(scene->stage().seen_ground()->frame == number);
        // Whatever was seen before.
        scene->stage().show(random_moment(*scene, number + 1, random));
        CHECK(nodes() == first);
        tiles += first.size();
    }
    CHECK(tiles > 50);
}
