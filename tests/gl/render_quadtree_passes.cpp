// What the quadtree's passes find on the GPU is what the CPU finds, number by number: shapes, the level
// matrix, and how far cells have turned; while tiles are late, over random terrain of awkward sizes, and over
// a real one. Sixty views of each, a thousand with RIDGELINE_LONG=1.
#include <cstdlib>
#include <optional>
#include <random>

#include "gl/render_scene.h"
#include "ridgeline/render/asked_block.h"
#include "ridgeline/render/quadtree_lod.h"
#include "ridgeline/shaders/lib/quadtree_levels.h"
#include "support/built_store.h"
#include "support/data.h"
#include "unit/build_fixture.h"

using namespace ridgeline;
using namespace ridgeline::test;

namespace {

int views_to_try() { return std::getenv("RIDGELINE_LONG") ? 1000 : 60; }

double uniform(std::mt19937& random, double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random);
}

// A terrain among many: waves of some lengths and heights, terraces, spikes, plains.
struct Waves {
    double height = 20.0, across = 0.03, down = 0.05, fine = 0.2;
    int terrace = 1, spikes = 97;
};
// quanta() has no state of its own.
Waves waves;

std::int32_t wavy_quanta(std::int64_t x, std::int64_t y) {
    const double u = static_cast<double>(x), v = static_cast<double>(y);
    const double broad = std::sin(u * waves.across + std::sin(v * waves.down)) * std::cos(v * waves.across);
    const double fine = 0.1 * std::sin(u * waves.fine) * std::sin(v * waves.fine * 0.8);
    const double spike = (x * 7919 + y * 104729) % waves.spikes == 0 ? 0.3 : 0.0;
    const auto quanta = static_cast<std::int32_t>(std::lround(waves.height * (broad + fine + spike)));
    return std::max(quanta, 0) / waves.terrace * waves.terrace;
}

void make_waves(std::mt19937& random) {
    waves.height = std::exp(uniform(random, std::log(2.0), std::log(120.0)));
    waves.across = std::exp(uniform(random, std::log(0.003), std::log(0.1)));
    waves.down = std::exp(uniform(random, std::log(0.003), std::log(0.1)));
    waves.fine = uniform(random, 0.1, 1.0);
    waves.terrace = random() % 3 == 0 ? 1 + static_cast<int>(random() % 50) : 1;
    waves.spikes = 50 + static_cast<int>(random() % 2000);
}

app::StageOptions quadtree_stage(std::mt19937& random) {
    app::StageOptions options;
    options.frame.size_px = {64, 48};
    options.frame.surfaces = render::Surfaces::all;
    options.frame.gpu_cache_bytes = 6_MiB;
    options.pager.ram_bytes = 6_MiB;
    options.pager.fault.delay = std::chrono::milliseconds(1);
    options.pixel_error = std::exp(uniform(random, std::log(0.05), std::log(16.0)));
    if (random() % 2 == 0) options.criterion = "roughness";
    return options;
}

SceneOptions quadtree_scene(std::mt19937& random) {
    SceneOptions options;
    options.width = 33 + static_cast<int>(random() % 900);
    options.height = 33 + static_cast<int>(random() % 900);
    make_waves(random);
    options.quanta = wavy_quanta;
    options.stage = quadtree_stage(random);
    return options;
}

// Over the terrain and a little beside it, from close to the highest ground to a kilometre over it, and to
// half a kilometre below.
app::StageMoment random_moment(std::mt19937& random, const io::TerrainInfo& info) {
    app::StageMoment moment;
    moment.surface = render::Surface::quadtree;
    moment.camera.lens.size_px = {64, 48};
    moment.exaggeration = random() % 3 == 0 ? uniform(random, 0.5, 4.0) : 1.0;
    const double column = uniform(random, -20.0, static_cast<double>(info.width) + 20.0);
    const double row = uniform(random, -20.0, static_cast<double>(info.height) + 20.0);
    const double up_m = std::exp(uniform(random, 0.5, 7.0));
    moment.camera.pose = {
        glm::dvec3(info.world(column, row), uniform(random, -500.0, info.max_height_m) + up_m),
        Angle::from_degrees(uniform(random, -180.0, 180.0)),
        Angle::from_degrees(uniform(random, -90.0, 20.0))};
    return moment;
}

struct Compared {
    std::int64_t shapes = 0, levels = 0, forced = 0, turning = 0;
    int wrong_shapes = 0, wrong_levels = 0, wrong_lods = 0;
};

std::vector<shaders::QuadtreeShape> shapes_on_cpu(app::TerrainStage& stage, const io::Grid& grid,
                                                  std::span<const shaders::QuadtreeShape> found,
                                                  Compared& compared) {
    std::vector<shaders::QuadtreeShape> shapes(found.begin(), found.end());
    const pager::Pager& pager = stage.pager();
    for (const auto& block : stage.frame().quadtree().blocks().blocks()) {
        if (!shaders::has_own_tile(block)) continue;
        const io::NodeId node{grid.finest() - block.coarseness, block.node.x, block.node.y};
        const auto bytes = pager.heights(pager.tiles().index(pager::TileKind::heights, node));
        const std::uint32_t slot = shaders::block_slot(block);
        shapes[slot] = render::quadtree_shape(bytes, {grid.quads(), node.level, 0, -1});
        ++compared.shapes;
        const bool same = std::ranges::equal(shapes[slot].error, found[slot].error) &&
                          shapes[slot].least == found[slot].least && shapes[slot].most == found[slot].most;
        compared.wrong_shapes += same ? 0 : 1;
    }
    return shapes;
}

void compare(app::TerrainStage& stage, const io::Grid& grid, Compared& compared) {
    const render::QuadtreeSurface& quadtree = stage.frame().quadtree();
    const auto shapes = shapes_on_cpu(stage, grid, quadtree.read_shapes(), compared);
    const auto cells = quadtree.read_cells();
    render::QuadtreeLod lod;
    lod.run(quadtree.uniforms(), quadtree.blocks(), shapes);
    const auto blocks = quadtree.blocks().blocks();
    std::optional<render::AskedBlock> asked;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const auto& block = blocks[i / shaders::kQuadtreeEntries];
        if (i % shaders::kQuadtreeEntries == 0) asked.emplace(lod, quadtree.uniforms(), block);
        const glm::ivec2 place = shaders::entry_place(static_cast<int>(i % shaders::kQuadtreeEntries));
        if (!shaders::has_entry(block, place)) continue;
        ++compared.levels;
        compared.wrong_levels += cells[i].level == lod.levels()[i] ? 0 : 1;
        compared.wrong_lods += cells[i].lod == lod.lods()[i] ? 0 : 1;
        compared.forced +=
            shaders::asked_level(quadtree.uniforms(), block, asked->cell(place)) != cells[i].level;
        compared.turning += block.fade > 0.0f && block.fade < 1.0f;
    }
}

void all_the_same(const Compared& compared) {
    CHECK(compared.wrong_shapes == 0);
    CHECK(compared.wrong_levels == 0);
    CHECK(compared.wrong_lods == 0);
    CHECK(compared.shapes > views_to_try());
    CHECK(compared.levels > 1000);
    // Or balancing would not have been looked at.
    CHECK(compared.forced > 100);
}

}  // namespace

TEST_CASE("The GPU's shapes and level matrix are the CPU's, number by number") {
    GlContext gl;
    if (!gl) return;
    std::mt19937 random(20261127);
    Compared compared;
    constexpr int kViewsPerLand = 6;
    for (int view = 0; view < views_to_try();) {
        const SceneOptions options = quadtree_scene(random);
        RenderScene scene(options);
        for (int i = 0; i < kViewsPerLand; ++i, ++view) {
            scene.stage().show(random_moment(random, scene.info()));
            compare(scene.stage(), scene.info().grid(), compared);
        }
    }
    all_the_same(compared);
}

TEST_CASE("So they are over real mountains, on the way as tiles arrive") {
    GlContext gl;
    if (!gl) return;
    const auto source = data_file("taiwan_central_8k.tif");
    if (source.empty()) return;
    const ScratchFolder folder;
    const io::Store store = built_store(source.string(), folder.path() / "taiwan.terrain");
    jobs::JobSystem jobs({.workers = 1});
    std::mt19937 random(5);
    Compared compared;
    constexpr int kViewsPerStage = 20;
    for (int view = 0; view < views_to_try();) {
        app::StageOptions options = quadtree_stage(random);
        options.frame.gpu_cache_bytes = options.pager.ram_bytes = 64_MiB;
        const auto stage = app::TerrainStage::create(store, jobs, options);
        REQUIRE(stage);
        for (int i = 0; i < kViewsPerStage; ++i, ++view) {
            app::StageMoment moment = random_moment(random, store.info());
            // Not settled, but not of the roots alone; and tiles turn.
            for (int frame = 0; frame < 6; ++frame) {
                moment.now = pager::Seconds(0.04 * (6 * view + frame));
                (*stage)->show(moment);
            }
            compare(**stage, store.grid(), compared);
        }
    }
    all_the_same(compared);
    CHECK(compared.turning > 100);
    MESSAGE(compared.levels, " entries over ", views_to_try(), " views, ", compared.forced,
            " of them balanced, ", compared.turning, " of turning tiles");
}

TEST_CASE("The picture is the same whoever chooses the levels") {
    GlContext gl;
    if (!gl) return;
    std::mt19937 random(3);
    SceneOptions options = quadtree_scene(random);
    options.width = 500, options.height = 333;
    options.stage.wait = app::TileWait::settle;
    RenderScene scene(options);
    std::vector<app::StageMoment> moments;
    for (int i = 0; i < 12; ++i) moments.push_back(random_moment(random, scene.info()));
    std::vector<gl::Image> by_gpu;
    for (const auto& moment : moments) {
        scene.stage().show(moment);
        by_gpu.push_back(gl::read_image(scene.stage().target()));
    }
    options.stage.frame.quadtree.lod = render::LodBy::cpu;
    scene.open(options.stage);
    std::size_t different = 0;
    for (std::size_t i = 0; i < moments.size(); ++i) {
        scene.stage().show(moments[i]);
        const gl::Image by_cpu = gl::read_image(scene.stage().target());
        for (std::size_t b = 0; b < by_cpu.rgb.size(); ++b)
            different +=
                std::abs(std::to_integer<int>(by_cpu.rgb[b]) - std::to_integer<int>(by_gpu[i].rgb[b])) > 2;
    }
    // A step more or less of turning moves a vertex by less than a hundredth of what the tolerated error is.
    CHECK(different < moments.size() * 64 * 48 / 1000);
}

// Of the last frame, by the levels that the CPU chooses.
std::size_t cells_in_view(RenderScene& scene) {
    const render::QuadtreeSurface& quadtree = scene.stage().frame().quadtree();
    Compared unused;
    const auto shapes = shapes_on_cpu(scene.stage(), scene.info().grid(), quadtree.read_shapes(), unused);
    render::QuadtreeLod lod;
    lod.run(quadtree.uniforms(), quadtree.blocks(), shapes);
    return lod.instances().size();
}

TEST_CASE("Cells for which there is no room are counted, whoever chooses the levels, and no others are") {
    GlContext gl;
    if (!gl) return;
    std::mt19937 random(4);
    SceneOptions options = quadtree_scene(random);
    options.width = options.height = 300;
    options.stage.criterion = "screen_error";
    options.stage.pixel_error = 0.2;
    options.stage.wait = app::TileWait::settle;
    RenderScene scene(options);
    const app::StageMoment moment = random_moment(random, scene.info());
    constexpr std::uint32_t kMost = 20, kTriangles = 2 * 4 * 4;
    for (const render::LodBy lod : {render::LodBy::gpu, render::LodBy::cpu}) {
        std::array<render::SurfaceCounters, 2> drawn;
        for (const bool narrow : {false, true}) {
            options.stage.frame.quadtree = {.lod = lod};
            if (narrow) options.stage.frame.quadtree.most_cells = kMost;
            scene.open(options.stage);
            // Counts arrive some frames later.
            for (int frame = 0; frame < 8; ++frame) {
                drawn[narrow] = scene.stage().show(moment).surface;
                glFinish();
            }
        }
        CHECK(drawn[0].left_out == 0);
        CHECK(drawn[0].triangles > kMost * kTriangles);
        CHECK(drawn[1].triangles == kMost * kTriangles);
        CHECK(drawn[1].left_out > 0);
        // Which cells find room is chance, and with them what is seen and paged next: of the last frame's own tiles.
        const shaders::QuadtreeCommands commands = scene.stage().frame().quadtree().read_commands();
        CHECK(commands.cells == kMost);
        CHECK(commands.left_out == cells_in_view(scene) - kMost);
    }
}
