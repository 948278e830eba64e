// What the quadtree's passes find on the GPU is what the CPU finds, number by number: shapes, the level matrix, and how far
// cells have turned; while tiles are late, over terrain of awkward shapes. Sixty views, a thousand with RIDGELINE_LONG=1.
#include <cstdlib>
#include <random>

#include "gl/render_scene.h"
#include "ridgeline/render/quadtree_lod.h"
#include "ridgeline/shaders/lib/quadtree.h"

using namespace ridgeline;
using namespace ridgeline::test;

namespace {

int views_to_try() { return std::getenv("RIDGELINE_LONG") ? 1000 : 60; }

double uniform(std::mt19937& random, double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random);
}

SceneOptions quadtree_scene(std::mt19937& random) {
    SceneOptions options;
    options.width = 33 + static_cast<int>(random() % 900);
    options.height = 33 + static_cast<int>(random() % 900);
    options.stage.frame.size_px = {64, 48};
    options.stage.frame.surfaces = render::Surfaces::all;
    options.stage.frame.gpu_cache_bytes = 6_MiB;
    options.stage.pager.ram_bytes = 6_MiB;
    options.stage.pager.fault.delay = std::chrono::milliseconds(1);
    options.stage.pixel_error = std::exp(uniform(random, std::log(0.2), std::log(8.0)));
    if (random() % 2 == 0) options.stage.criterion = "roughness";
    return options;
}

app::StageMoment random_moment(std::mt19937& random, const RenderScene& scene) {
    app::StageMoment moment;
    moment.surface = render::Surface::quadtree;
    moment.camera.lens.size_px = {64, 48};
    moment.exaggeration = random() % 3 == 0 ? uniform(random, 0.5, 4.0) : 1.0;
    const double column = uniform(random, -20.0, static_cast<double>(scene.info().width) + 20.0);
    const double row = uniform(random, -20.0, static_cast<double>(scene.info().height) + 20.0);
    moment.camera.pose = {scene.place(column, row, std::exp(uniform(random, 0.5, 7.0))),
                          Angle::from_degrees(uniform(random, -180.0, 180.0)),
                          Angle::from_degrees(uniform(random, -90.0, 20.0))};
    return moment;
}

struct Compared {
    std::int64_t shapes = 0, levels = 0, forced = 0;
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
        shapes[slot] = render::quadtree_shape(bytes, grid.quads());
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
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const auto& block = blocks[i / shaders::kQuadtreeEntries];
        const glm::ivec2 place = shaders::entry_place(static_cast<int>(i % shaders::kQuadtreeEntries));
        if (!shaders::has_entry(block, place)) continue;
        ++compared.levels;
        compared.wrong_levels += cells[i].level == lod.levels()[i] ? 0 : 1;
        // Divided: the last step may be rounded otherwise.
        compared.wrong_lods += std::abs(cells[i].lod - lod.lods()[i]) <= 1 ? 0 : 1;
        const int asked =
            shaders::asked_level(quadtree.uniforms(), block, shapes[shaders::block_slot(block)], place);
        compared.forced += asked != cells[i].level;
    }
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
            scene.stage().show(random_moment(random, scene));
            compare(scene.stage(), scene.info().grid(), compared);
        }
    }
    CHECK(compared.wrong_shapes == 0);
    CHECK(compared.wrong_levels == 0);
    CHECK(compared.wrong_lods == 0);
    CHECK(compared.shapes > views_to_try());
    CHECK(compared.levels > 1000);
    // Or balancing would not have been looked at.
    CHECK(compared.forced > 100);
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
    for (int i = 0; i < 12; ++i) moments.push_back(random_moment(random, scene));
    std::vector<gl::Image> by_gpu;
    for (const auto& moment : moments) {
        scene.stage().show(moment);
        by_gpu.push_back(gl::read_image(scene.stage().target()));
    }
    options.stage.frame.lod = render::LodBy::cpu;
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
