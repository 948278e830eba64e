// Ground made below the source as it is drawn: the GPU's tiles are the CPU's, whatever was made before them and however
// often they left; a frame makes no more than its budget; and nothing pops.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "gl/render_scene.h"
#include "ridgeline/app/bench/background_pixels.h"
#include "ridgeline/app/bench/descent.h"
#include "ridgeline/app/walk/course.h"
#include "ridgeline/detail/detail_tile.h"
#include "ridgeline/detail/finer_ground.h"
#include "ridgeline/select/surface_query.h"
#include "support/built_store.h"
#include "support/data.h"
#include "support/drawn_quadtree.h"
#include "unit/build_fixture.h"

using namespace ridgeline;
using namespace ridgeline::test;

namespace {

constexpr int kOctaves = 3;

SceneOptions made_scene(std::uint64_t gpu_cache_bytes) {
    SceneOptions options;
    options.stage.frame.surfaces = render::Surfaces::all;
    options.stage.frame.detail_octaves = kOctaves;
    options.stage.frame.gpu_cache_bytes = gpu_cache_bytes;
    options.stage.frame.size_px = {200, 150};
    return options;
}

double uniform(std::mt19937& random, double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random);
}

app::StageMoment moment_at(const RenderScene& scene, double column, double row, double above_m) {
    app::StageMoment moment;
    moment.surface = render::Surface::disc;
    moment.camera.lens.size_px = {200, 150};
    moment.camera.pose = {scene.place(column, row, scene.surface_m(column, row) + above_m), Angle(),
                          Angle::from_degrees(-15.0)};
    return moment;
}

app::StageMoment random_moment(std::mt19937& random, const RenderScene& scene) {
    const auto last = static_cast<double>(scene.info().width - 2);
    app::StageMoment moment = moment_at(scene, uniform(random, 1.0, last), uniform(random, 1.0, last),
                                        std::exp(uniform(random, 0.0, 4.0)));
    moment.camera.pose.heading = Angle::from_degrees(uniform(random, -180.0, 180.0));
    return moment;
}

// Not at the picture's edges, where ground comes into view.
bool is_well_in_view(const glm::dvec3& way_m, const platform::Camera& camera) {
    const glm::dvec3 seen = platform::view_from_world(camera.pose) * way_m;
    const glm::dvec2 tangents = 0.85 * platform::half_tangents(camera.lens);
    return seen.z < 0.0 && std::abs(seen.x) < -seen.z * tangents.x && std::abs(seen.y) < -seen.z * tangents.y;
}

// By the rules of terrain/detail alone, from the reference terrain's samples.
detail::DetailTile reference_tile(const RenderScene& scene, io::NodeId node) {
    const int octaves = node.level - scene.info().grid().finest();
    const io::NodeId source{node.level - octaves, node.x >> octaves, node.y >> octaves};
    detail::DetailTile tile, child;
    detail::make_root(scene.terrain().heights_tile(source), source, detail::detail_shift(scene.info()), tile);
    for (int below = octaves - 1; below >= 0; --below) {
        const int quarter = (node.x >> below & 1) + 2 * (node.y >> below & 1);
        detail::make_child(tile, quarter, SmallStore::detail().octaves[0], child);
        std::swap(tile, child);
    }
    return tile;
}

std::vector<std::int32_t> texels_on_gpu(const render::HeightTexture& heights, std::uint32_t slot) {
    const int side = pager::heights_texels_side(heights.quads());
    std::vector<std::int32_t> texels(static_cast<std::size_t>(side * side));
    glGetTextureSubImage(heights.tiles().texture().id(), 0, 0, 0, static_cast<GLint>(slot), side, side, 1,
                         GL_RED_INTEGER, GL_INT, static_cast<GLsizei>(texels.size() * sizeof texels[0]),
                         texels.data());
    return texels;
}

// How many of a frame's made tiles were looked at; all of their samples, aprons included.
int check_made_tiles(const RenderScene& scene, const render::Frame& frame) {
    int looked_at = 0;
    frame.made_tiles()->for_each_wanted([&](io::NodeId node, std::uint32_t slot) {
        const std::vector<std::int32_t> texels = texels_on_gpu(frame.heights(), slot);
        const detail::DetailTile reference = reference_tile(scene, node);
        std::size_t wrong = 0;
        for (std::size_t i = 0; i < texels.size(); ++i)
            wrong += texels[i] >> 1 != reference.heights[i] ? 1 : 0;
        CHECK(wrong == 0);
        ++looked_at;
    });
    return looked_at;
}

}  // namespace

TEST_CASE("Tiles that the GPU made are the reference's, bit by bit, however often they came and went") {
    GlContext gl;
    if (!gl) return;
    // Of a few slots, for many more tiles.
    RenderScene scene(made_scene(3_MiB));
    std::mt19937 random(20261127);
    int looked_at = 0;
    for (int place = 0; place < 8; ++place) {
        app::StageMoment moment = random_moment(random, scene);
        moment.now = pager::Seconds(10.0 * place);
        for (int i = 0; i < 12; ++i, moment.now += pager::Seconds(0.3)) scene.stage().show(moment);
        looked_at += check_made_tiles(scene, scene.stage().frame());
    }
    const render::MadeCounters& counters = scene.stage().frame().made_tiles()->counters();
    MESSAGE("tiles looked at: ", looked_at, ", made: ", counters.made_ever, ", held: ", counters.held);
    CHECK(looked_at > 30);
    // They did leave.
    CHECK(counters.made_ever > 2 * counters.held);
}

// Looking down: where ground hides ground, what is wanted depends on what was seen, and that on what was there.
TEST_CASE("A picture of made ground is the same whatever was looked at before") {
    GlContext gl;
    if (!gl) return;
    SceneOptions options = made_scene(3_MiB);
    options.stage.wait = app::TileWait::settle;
    RenderScene scene(options);
    std::mt19937 random(7);
    for (const render::Surface surface :
         {render::Surface::mesh, render::Surface::disc, render::Surface::quadtree}) {
        app::StageMoment moment = random_moment(random, scene);
        moment.surface = surface;
        moment.camera.pose.pitch = Angle::from_degrees(-70.0);
        scene.stage().show(moment);
        const gl::Image fresh = gl::read_image(scene.stage().target());
        for (int i = 0; i < 3; ++i) scene.stage().show(random_moment(random, scene));
        scene.stage().show(moment);
        CHECK(gl::read_image(scene.stage().target()).rgb == fresh.rgb);
    }
}

TEST_CASE("Cells over made ground are those of the CPU, wherever levels are chosen") {
    GlContext gl;
    if (!gl) return;
    SceneOptions options = made_scene(64_MiB);
    options.stage.wait = app::TileWait::settle;
    std::vector<std::vector<std::byte>> pictures;
    for (const render::LodBy lod : {render::LodBy::gpu, render::LodBy::cpu}) {
        options.stage.frame.quadtree.lod = lod;
        RenderScene scene(options);
        app::StageMoment moment = moment_at(scene, 90, 170, 3.0);
        moment.surface = render::Surface::quadtree;
        scene.stage().show(moment);
        CHECK(scene.stage().frame().made_tiles()->counters().held > 20);
        pictures.push_back(gl::read_image(scene.stage().target()).rgb);
    }
    CHECK(pictures[0] == pictures[1]);
}

TEST_CASE("Made ground is drawn of a terrain smaller than a tile, and of one with several roots") {
    GlContext gl;
    if (!gl) return;
    for (const glm::ivec2 size : {glm::ivec2(9, 12), {150, 20}, {2, 2}})
        for (const render::Surface surface :
             {render::Surface::mesh, render::Surface::disc, render::Surface::quadtree}) {
            CAPTURE(size.x);
            SceneOptions options = made_scene(64_MiB);
            options.width = size.x;
            options.height = size.y;
            options.stage.wait = app::TileWait::settle;
            RenderScene scene(options);
            app::StageMoment moment = moment_at(scene, size.x / 2.0 - 0.4, size.y / 2.0 - 0.4, 1.5);
            moment.surface = surface;
            moment.camera.pose.pitch = Angle::from_degrees(-89.0);
            scene.stage().show(moment);
            CHECK(scene.stage().frame().made_tiles()->counters().held > 0);
            CHECK(check_made_tiles(scene, scene.stage().frame()) > 0);
            CHECK(scene.stage().frame().surface_counters().triangles > 0);
            if (surface == render::Surface::mesh) CHECK(!scene.stage().frame().made_region().nodes().empty());
        }
}

TEST_CASE("No frame makes more tiles than its budget, and a still eye gets all of them in the end") {
    GlContext gl;
    if (!gl) return;
    RenderScene scene(made_scene(64_MiB));
    app::StageMoment moment = moment_at(scene, 120, 130, 2.0);
    std::uint32_t most = 0;
    for (int i = 0; i < 60; ++i, moment.now += pager::Seconds(0.1)) {
        scene.stage().show(moment);
        most = std::max(most, scene.stage().frame().made_tiles()->counters().made);
    }
    const render::MadeCounters& counters = scene.stage().frame().made_tiles()->counters();
    CHECK(most == app::kMadeTilesPerFrame);
    CHECK(counters.wanted > 20);
    CHECK(counters.missing == 0);
    CHECK(counters.made_ever == counters.held);
}

namespace {

// How high the last frame drew a place: exactly, where the walk itself asks how high it may be at most.
class DrawnHeights {
  public:
    DrawnHeights(app::TerrainStage& stage, render::Surface surface, const platform::Camera& camera)
        : stage_(stage), surface_(surface), eye_m_(camera.pose.eye_m) {
        if (surface == render::Surface::quadtree || has_cells()) quadtree_.emplace(stage);
    }
    // Nothing where chunks are hidden.
    std::optional<double> height_m(const glm::dvec2& place_m) {
        if (surface_ == render::Surface::mesh && !is_drawn(place_m)) return {};
        if (!by_cells(place_m)) {
            const auto ground = stage_.ground_below(place_m);
            return ground ? std::optional(ground->drawn_m) : std::nullopt;
        }
        const auto over_eye_m = quadtree_->height_m(place_m);
        return over_eye_m ? std::optional(eye_m_.z + *over_eye_m) : std::nullopt;
    }

  private:
    bool is_drawn(const glm::dvec2& place_m) const {
        const io::Grid& grid = stage_.pager().tiles().grid(pager::TileKind::chunk);
        const glm::dvec2 place = source_place(place_m);
        return std::ranges::any_of(stage_.selection().draws, [&](const select::DrawEntry& entry) {
            const glm::dvec2 within = place / static_cast<double>(grid.extent(entry.node.level)) -
                                      glm::dvec2(entry.node.x, entry.node.y);
            if (within.x < 0.0 || within.y < 0.0 || within.x >= 1.0 || within.y >= 1.0) return false;
            const int quarter = (within.x >= 0.5 ? 1 : 0) + (within.y >= 0.5 ? 2 : 0);
            return (entry.quarters >> quarter & 1) != 0;
        });
    }
    // The mesh's, in place of some chunks.
    bool has_cells() const {
        return surface_ == render::Surface::mesh && stage_.frame().made_tiles() &&
               !stage_.frame().made_region().nodes().empty();
    }
    bool by_cells(const glm::dvec2& place_m) const {
        if (!has_cells()) return surface_ == render::Surface::quadtree;
        return stage_.frame().made_region().concerns_place(source_place(place_m));
    }
    glm::dvec2 source_place(const glm::dvec2& place_m) const {
        const io::TerrainInfo& sampled = stage_.frame().sampled_info();
        const io::Grid& source = stage_.pager().tiles().grid(pager::TileKind::chunk);
        return sampled.lattice(place_m.x, place_m.y) * std::exp2(source.finest() - sampled.grid().finest());
    }

    app::TerrainStage& stage_;
    render::Surface surface_;
    glm::dvec3 eye_m_;
    std::optional<DrawnQuadtree> quadtree_;
};

// What a picture shows of the ground, and what other ground in front of it hides.
class ShownGround {
  public:
    ShownGround(const gl::Framebuffer& target, const platform::Camera& camera)
        : camera_(camera), depths_(static_cast<std::size_t>(camera.lens.size_px.x * camera.lens.size_px.y)) {
        glBindFramebuffer(GL_READ_FRAMEBUFFER, target.id());
        glReadPixels(0, 0, camera.lens.size_px.x, camera.lens.size_px.y, GL_DEPTH_COMPONENT, GL_FLOAT,
                     depths_.data());
    }
    // A place well inside the picture, a pixel beside what is hidden at most.
    bool shows(const glm::dvec3& place_m) const {
        constexpr double kSlack = 1.02;
        const glm::dvec3 way_m = place_m - camera_.pose.eye_m;
        if (!is_well_in_view(way_m, camera_)) return false;
        const glm::dvec3 seen = platform::view_from_world(camera_.pose) * way_m;
        const glm::ivec2 size_px = camera_.lens.size_px;
        const glm::dvec2 at = glm::dvec2(seen) / -seen.z / platform::half_tangents(camera_.lens);
        const glm::ivec2 pixel(0.5 * (at + 1.0) * glm::dvec2(size_px));
        for (const int row : {-1, 0, 1})
            for (const int column : {-1, 0, 1}) {
                const auto i = static_cast<std::size_t>((pixel.y + row) * size_px.x + pixel.x + column);
                if (-seen.z * static_cast<double>(depths_[i]) <= kSlack * camera_.lens.near_m) return true;
            }
        return false;
    }

  private:
    platform::Camera camera_;
    std::vector<float> depths_;  // near over distance, rows from the lowest
};

// Places on the ground, and how far they move from frame to frame, as the picture has them.
class WatchedPlaces {
  public:
    void watch(const glm::dvec2& place_m, DrawnHeights& ground, const ShownGround& picture) {
        Place place{.at_m = place_m};
        look(place, ground, picture);
        places_.push_back(place);
    }
    void forget() { places_.clear(); }
    // After a frame with this camera.
    void look_again(const platform::Camera& camera, DrawnHeights& ground, const ShownGround& picture) {
        for (Place& place : places_) {
            const Place before = place;
            look(place, ground, picture);
            if (!place.drawn_m || !before.drawn_m || (!place.seen && !before.seen)) continue;
            const glm::dvec3 way_m = glm::dvec3(place.at_m, *place.drawn_m) - camera.pose.eye_m;
            if (!is_well_in_view(way_m, camera)) continue;
            const double moved_px = std::abs(*place.drawn_m - *before.drawn_m) *
                                    platform::pixels_per_tangent(camera.lens) / glm::length(way_m);
            most_px_ = std::max(most_px_, moved_px);
            ++looked_at_;
        }
    }
    double most_px() const { return most_px_; }
    int looked_at() const { return looked_at_; }

  private:
    struct Place {
        glm::dvec2 at_m{0.0};
        std::optional<double> drawn_m{};
        bool seen = false;
    };
    static void look(Place& place, DrawnHeights& ground, const ShownGround& picture) {
        place.drawn_m = ground.height_m(place.at_m);
        place.seen = place.drawn_m && picture.shows(glm::dvec3(place.at_m, *place.drawn_m));
    }
    std::vector<Place> places_;
    double most_px_ = 0.0;
    int looked_at_ = 0;
};

std::int32_t rolling_quanta(std::int64_t x, std::int64_t y) {
    const double u = static_cast<double>(x), v = static_cast<double>(y);
    return static_cast<std::int32_t>(
        std::lround(12.0 * std::sin(u * 0.05) * std::cos(v * 0.04) + 3.0 * std::sin(u * 0.31 + v * 0.17)));
}

// However busy the machine is, tiles come at the moment that they are wanted at: where they are late, the mesh changes
// hands near the eye (docs/detail.md, limits).
void show_with_quick_disk(app::TerrainStage& stage, app::StageMoment moment, std::uint64_t& shown) {
    constexpr int kMostLooks = 40;
    int looks = 0;
    do {
        moment.number = shown++;
        stage.show(moment);
    } while (!stage.pager().settled() && ++looks < kMostLooks);
}

// From high above down to two metres, then on at 50 m/s.
void come_down_and_run(render::Surface surface, const SceneOptions& options) {
    RenderScene scene(options);
    const double frame_s = 1.0 / 60.0;
    WatchedPlaces places;
    std::uint32_t made = 0;
    std::uint64_t shown = 0;
    for (int frame = 0; frame < 260; ++frame) {
        const double down = std::min(frame / 180.0, 1.0);
        const double above_m = 2.0 + 250.0 * std::pow(1.0 - down, 3.0);
        const double run_m = frame > 180 ? (frame - 180) * frame_s * 50.0 : 0.0;
        app::StageMoment moment = moment_at(scene, 128, 160.0 - run_m, above_m);
        moment.surface = surface;
        moment.camera.pose.eye_m.z = 14.0 + above_m;
        moment.now = pager::Seconds(frame * frame_s);
        show_with_quick_disk(scene.stage(), moment, shown);
        made += scene.stage().frame().made_tiles()->counters().made;
        // Until level 0's own tiles have come and turned.
        if (frame < 39) continue;
        DrawnHeights ground(scene.stage(), surface, moment.camera);
        const ShownGround picture(scene.stage().target(), moment.camera);
        if (frame > 39) places.look_again(moment.camera, ground, picture);
        if (frame == 39)
            for (int row = 60; row < 130; row += 5)
                for (int column = 100; column < 160; column += 5)
                    places.watch(glm::dvec2(scene.place(column + 0.3, row + 0.4, 0.0)), ground, picture);
    }
    MESSAGE("moves by ", places.most_px(), " px at most; tiles made: ", made);
    CHECK(made > 100);
    CHECK(places.looked_at() > 1000);
    CHECK(places.most_px() < 1.0);
}

// Of a picture's pixels with ground in them, the places of so many.
std::vector<glm::dvec2> places_in_view(select::SurfaceQuery& ground, const platform::Camera& camera,
                                       int count, std::mt19937& random) {
    const glm::dmat3 world_from_view = glm::transpose(platform::view_from_world(camera.pose));
    const glm::dvec2 tangents = 0.8 * platform::half_tangents(camera.lens);
    std::vector<glm::dvec2> places;
    for (int i = 0; i < count; ++i) {
        const glm::dvec3 seen(uniform(random, -tangents.x, tangents.x),
                              uniform(random, -tangents.y, tangents.y), -1.0);
        const auto hit = ground.ray_cast(camera.pose.eye_m, world_from_view * seen, 30'000.0);
        REQUIRE(hit.ok());
        if (hit->hit) places.emplace_back(hit->point_m);
    }
    return places;
}

// The descent of suite `synthesis`, every one of its frames at sixty a second.
void descend(const io::Store& store, const app::Descent& course, render::Surface surface, int octaves) {
    constexpr int kWarm = 60, kFrames = 1200, kPlaces = 16;
    app::StageOptions options = made_scene(256_MiB).stage;
    options.frame.size_px = {128, 96};
    options.frame.detail_octaves = octaves;
    jobs::JobSystem jobs({.workers = 1});
    const auto stage = app::TerrainStage::create(store, jobs, options);
    REQUIRE(stage.ok());
    select::SurfaceQuery ground(store, {.detail_levels = octaves}), source(store);
    WatchedPlaces places;
    std::mt19937 random(5);
    int background = 0;
    std::uint32_t most_made = 0;
    std::uint64_t made = 0;
    // Ten seconds down, ten along.
    for (int frame = -kWarm; frame < kFrames; ++frame) {
        const app::DescentMoment at = course.at(std::max(frame, 0) / static_cast<double>(kFrames));
        const auto under = ground.height(at.pose.eye_m.x, at.pose.eye_m.y);
        REQUIRE((under.ok() && under->kind == select::SurfaceHeight::Kind::ground));
        app::StageMoment moment;
        moment.surface = surface;
        moment.camera = {at.pose, {.size_px = options.frame.size_px}};
        moment.camera.pose.eye_m.z += under->height_m;
        moment.number = static_cast<std::uint64_t>(frame + kWarm);
        moment.now = pager::Seconds((frame + kWarm) / 60.0);
        moment.speed_m_per_s = at.speed_m_per_s;
        moment.background = render::PlainBackground{255, 0, 255};
        moment.camera.pose.eye_m.z += (*stage)->show(moment).eye_lift_m;
        if (frame < 0) continue;
        background += app::BackgroundPixels(gl::read_image((*stage)->target()), {255, 0, 255})
                          .count_wrong(moment.camera);
        if (const render::MadeTiles* tiles = (*stage)->frame().made_tiles()) {
            most_made = std::max(most_made, tiles->counters().made);
            made = tiles->counters().made_ever;
        }
        DrawnHeights drawn(**stage, surface, moment.camera);
        const ShownGround picture((*stage)->target(), moment.camera);
        places.look_again(moment.camera, drawn, picture);
        places.forget();
        for (const glm::dvec2& place : places_in_view(source, moment.camera, kPlaces, random))
            places.watch(place, drawn, picture);
    }
    MESSAGE("octaves ", octaves, ": moves by ", places.most_px(), " px at most in ", places.looked_at(),
            " looks; background pixels ", background, "; tiles made ", made, ", in a frame ", most_made,
            " at most");
    CHECK(places.looked_at() > 1000);
    CHECK(places.most_px() < 1.0);
    CHECK(background == 0);
    CHECK(most_made <= app::kMadeTilesPerFrame);
}

}  // namespace

TEST_CASE("Nothing pops while the eye comes down and runs over made ground") {
    GlContext gl;
    if (!gl) return;
    SceneOptions options = made_scene(64_MiB);
    options.quanta = rolling_quanta;
    for (const render::Surface surface : {render::Surface::disc, render::Surface::quadtree})
        come_down_and_run(surface, options);
    // Whose finest chunks are cruder here than the builder makes them.
    options.quanta = [](std::int64_t x, std::int64_t y) { return rolling_quanta(x, y) / 2; };
    come_down_and_run(render::Surface::mesh, options);
}

TEST_CASE("From 5 km down to half a metre and along real ground at 50 m/s nothing shows through or pops") {
    if (std::getenv("RIDGELINE_LONG") == nullptr) return;
    GlContext gl;
    if (!gl) return;
    const auto source = data_file("taiwan_central_8k.tif");
    if (source.empty()) return;
    const ScratchFolder folder;
    const io::Store store = built_store(source.string(), folder.path() / "taiwan.terrain");
    const auto path = app::resolve_course(store, {app::PathChoice::Kind::ground, {}}, 1.0);
    REQUIRE(path.ok());
    const app::Descent course(*path);
    const int octaves = detail::most_octaves(store.info());
    SUBCASE("disc") { descend(store, course, render::Surface::disc, octaves); }
    SUBCASE("mesh without made ground") { descend(store, course, render::Surface::mesh, 0); }
    SUBCASE("mesh") { descend(store, course, render::Surface::mesh, octaves); }
    SUBCASE("quadtree without made ground") { descend(store, course, render::Surface::quadtree, 0); }
    SUBCASE("quadtree") { descend(store, course, render::Surface::quadtree, octaves); }
}

TEST_CASE("Made ground that no surface shows gives up its slots, and comes back") {
    GlContext gl;
    if (!gl) return;
    SceneOptions options = made_scene(64_MiB);
    options.stage.wait = app::TileWait::settle;
    RenderScene scene(options);
    for (const render::Surface surface : {render::Surface::mesh, render::Surface::quadtree}) {
        app::StageMoment moment = moment_at(scene, 120, 130, 5.0);
        moment.surface = surface;
        const auto held = [&](bool detail) {
            moment.detail = detail;
            scene.stage().show(moment);
            return scene.stage().frame().made_tiles()->counters().held;
        };
        CHECK(held(true) > 0);
        CHECK(held(false) == 0);
        CHECK(held(true) > 0);
    }
}

TEST_CASE(
    "The mesh gives way to made ground however flat and coarse the land about it is, and the picture small") {
    GlContext gl;
    if (!gl) return;
    SceneOptions options = made_scene(64_MiB);
    // A hillock in a plain that one triangle could be.
    options.quanta = [](std::int64_t x, std::int64_t y) {
        return static_cast<std::int32_t>(
            std::max<std::int64_t>(0, 60 - (x - 120) * (x - 120) - (y - 130) * (y - 130)));
    };
    options.stage.wait = app::TileWait::settle;
    options.stage.frame.size_px = {32, 24};
    for (const double pixel_error : {1.0, 4.0}) {
        options.stage.pixel_error = pixel_error;
        RenderScene scene(options);
        app::StageMoment moment = moment_at(scene, 120, 135, 3.0);
        moment.surface = render::Surface::mesh;
        moment.camera.lens.size_px = options.stage.frame.size_px;
        scene.stage().show(moment);
        CHECK(scene.stage().frame().made_tiles()->counters().held > 0);
        CHECK(scene.stage().frame().made_region().concerns_place({120.0, 135.0}));
    }
}

TEST_CASE("Made ground that is switched off leaves the source's, as without any") {
    GlContext gl;
    if (!gl) return;
    SceneOptions options = made_scene(64_MiB);
    options.stage.wait = app::TileWait::settle;
    RenderScene scene(options);
    app::StageMoment moment = moment_at(scene, 120, 130, 20.0);
    scene.stage().show(moment);
    const gl::Image with = gl::read_image(scene.stage().target());
    moment.detail = false;
    for (int i = 0; i < 3; ++i) scene.stage().show(moment);
    CHECK(gl::read_image(scene.stage().target()).rgb != with.rgb);
    const glm::dvec2 place = glm::dvec2(scene.place(124, 120, 0.0));
    const auto off = scene.stage().ground_below(place);
    options.stage.frame.detail_octaves = 0;
    scene.open(options.stage);
    scene.stage().show(moment);
    const auto without = scene.stage().ground_below(place);
    REQUIRE((off && without));
    CHECK(off->drawn_m == doctest::Approx(without->drawn_m).epsilon(1e-5));
}
