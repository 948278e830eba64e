// Ground made below the source as it is drawn: the GPU's tiles are the CPU's, whatever was made before them and however
// often they left; a frame makes no more than its budget; and nothing pops.
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "gl/render_scene.h"
#include "ridgeline/detail/detail_tile.h"

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
        for (int i = 0; i < 5; ++i, moment.now += pager::Seconds(0.3)) scene.stage().show(moment);
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
    for (const auto& [width, height] : {std::pair{9, 12}, {150, 20}, {2, 2}})
        for (const render::Surface surface :
             {render::Surface::mesh, render::Surface::disc, render::Surface::quadtree}) {
            CAPTURE(width);
            SceneOptions options = made_scene(64_MiB);
            options.width = width;
            options.height = height;
            options.stage.wait = app::TileWait::settle;
            RenderScene scene(options);
            app::StageMoment moment = moment_at(scene, width / 2.0 - 0.4, height / 2.0 - 0.4, 1.5);
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

// From high above down to two metres, then on at 50 m/s: places on the ground, as the picture has them.
TEST_CASE("Nothing pops while the eye comes down and runs over made ground") {
    GlContext gl;
    if (!gl) return;
    SceneOptions options = made_scene(64_MiB);
    options.quanta = [](std::int64_t x, std::int64_t y) {
        const double u = static_cast<double>(x), v = static_cast<double>(y);
        return static_cast<std::int32_t>(std::lround(12.0 * std::sin(u * 0.05) * std::cos(v * 0.04) +
                                                     3.0 * std::sin(u * 0.31 + v * 0.17)));
    };
    RenderScene scene(options);
    std::vector<glm::dvec2> places;
    for (int row = 60; row < 130; row += 3)
        for (int column = 100; column < 160; column += 3)
            places.emplace_back(glm::dvec2(scene.place(column + 0.3, row + 0.4, 0.0)));
    const double frame_s = 1.0 / 60.0;
    std::vector<double> before;
    double most_px = 0.0;
    std::uint32_t made = 0;
    for (int frame = 0; frame < 260; ++frame) {
        const double down = std::min(frame / 180.0, 1.0);
        const double above_m = 2.0 + 250.0 * std::pow(1.0 - down, 3.0);
        const double run_m = frame > 180 ? (frame - 180) * frame_s * 50.0 : 0.0;
        app::StageMoment moment = moment_at(scene, 128, 160.0 - run_m, above_m);
        moment.camera.pose.eye_m.z = 14.0 + above_m;
        moment.now = pager::Seconds(frame * frame_s);
        moment.number = static_cast<std::uint64_t>(frame);
        scene.stage().show(moment);
        made += scene.stage().frame().made_tiles()->counters().made;
        const double projection_px = 100.0 / std::tan(Angle::from_degrees(37.5).radians());
        std::vector<double> now;
        for (std::size_t i = 0; i < places.size(); ++i) {
            const auto ground = scene.stage().ground_below(places[i]);
            now.push_back(ground ? ground->drawn_m : 0.0);
            // Until level 0's own tiles have come and turned.
            const glm::dvec3 way = glm::dvec3(places[i], now[i]) - moment.camera.pose.eye_m;
            const double distance_m = glm::length(way);
            if (frame < 40 || !is_well_in_view(way, moment.camera)) continue;
            const double px = std::abs(now[i] - before[i]) * projection_px / distance_m;
            most_px = std::max(most_px, px);
        }
        before = now;
    }
    MESSAGE("moves by ", most_px, " px at most; tiles made: ", made);
    CHECK(made > 100);
    CHECK(most_px < 1.0);
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
