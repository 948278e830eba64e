// The horizon's panels and what is measured over a walked terrain: that they show it, and that they cost no
// memory.
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "gl/render_scene.h"
#include "ridgeline/app/hud/hud.h"
#include "ridgeline/app/hud/imgui_layer.h"
#include "ridgeline/app/hud/level_look.h"
#include "ridgeline/app/walk/level_survey.h"
#include "ridgeline/telemetry/allocation_counter.h"

using namespace ridgeline;
using namespace ridgeline::test;

namespace {

const glm::ivec2 kSize_px(640, 480);

std::uint64_t imgui_allocations = 0;

// ImGui asks malloc, which the counter does not see.
void count_imgui() {
    ImGui::SetAllocatorFunctions(
        [](std::size_t bytes, void*) {
            ++imgui_allocations;
            return std::malloc(bytes);
        },
        [](void* memory, void*) { std::free(memory); });
}

SceneOptions small_scene(select::HorizonMode horizon, app::TileWait wait, render::Surfaces surfaces) {
    SceneOptions options;
    options.width = options.height = 1025;
    options.stage.frame.size_px = kSize_px;
    options.stage.frame.gpu_cache_bytes = 16_MiB;
    options.stage.pager.ram_bytes = 8_MiB;
    options.stage.horizon = horizon;
    options.stage.wait = wait;
    options.stage.frame.surfaces = surfaces;
    return options;
}

// A walk with the HUD over it, frame by frame.
class Walk {
  public:
    Walk(test::GlContext& gl, select::HorizonMode horizon, app::TileWait wait = app::TileWait::never,
         render::Surfaces surfaces = render::Surfaces::mesh_only)
        : scene_(small_scene(horizon, wait, surfaces)) {
        if (surfaces == render::Surfaces::all) REQUIRE(stage().allow_level_matrix());
        auto layer = app::ImguiLayer::create(gl.context());
        REQUIRE(layer);
        layer_ = std::move(layer).value();
    }

    app::TerrainStage& stage() { return scene_.stage(); }
    const app::HorizonScene& horizon() const { return horizon_; }

    // Round about the middle, close to the ground, turning.
    void show(int frame, app::Panel horizon_view, app::MapRange range = app::MapRange::fitting) {
        app::StageMoment moment;
        moment.number = static_cast<std::uint64_t>(frame);
        moment.camera.lens.size_px = kSize_px;
        moment.now = pager::Seconds(frame / 60.0);
        const double angle = 6.283185307 * frame / 60.0;
        moment.camera.pose = {scene_.place(512 + 300 * std::cos(angle), 512 + 300 * std::sin(angle), 48.0),
                              Angle::from_radians(2.0 * angle), Angle::from_degrees(-3.0)};
        moment.surface = surface_;
        moment.reads_levels = surface_ == render::Surface::quadtree;
        stage().show(moment);
        app::HudView view;
        view.pose = moment.camera.pose;
        if (moment.reads_levels) {
            // What was just drawn.
            glFinish();
            const render::LevelMatrix* matrix = stage().level_matrix();
            REQUIRE(matrix != nullptr);
            app::survey_levels(*matrix, scene_.info(), moment.camera.pose.eye_m, levels_);
            for (std::size_t level = 0; level < levels_at_least_; ++level) ++levels_.drawn[level];
            view.levels = &levels_;
        }
        if (horizon_view == app::Panel::shown) {
            stage().survey(moment, horizon_);
            view.horizon = &horizon_;
        }
        if (measured_) {
            measured_->camera = moment.camera;
            view.measured = &*measured_;
        }
        app::WalkSettings settings;
        settings.map_range = range;
        layer_->begin_frame(kSize_px, std::chrono::duration<double>(1.0 / 60.0));
        hud_.build(view, settings);
        layer_->draw(stage().target());
    }
    // The quadtree with its levels on the map, where they have come back.
    void show_levels(int frame) {
        surface_ = render::Surface::quadtree;
        show(frame, app::Panel::shown);
    }
    void pretend_levels(std::size_t count) { levels_at_least_ = count; }
    const app::LevelScene& levels() const { return levels_; }
    // A line across the middle, with a gap; or nothing.
    void measure(const app::HeightProfile& profile) {
        measured_.emplace();
        measured_->points_m = {scene_.place(300, 300, scene_.surface_m(300, 300)),
                               scene_.place(700, 700, scene_.surface_m(700, 700))};
        measured_->degrees[0] = glm::dvec2(121.0, 23.5);
        measured_->profile = profile;
    }
    gl::Image picture() { return gl::read_image(stage().target()); }

  private:
    RenderScene scene_;
    std::unique_ptr<app::ImguiLayer> layer_;
    app::Hud hud_;
    app::HorizonScene horizon_;
    app::LevelScene levels_;
    std::size_t levels_at_least_ = 0;
    render::Surface surface_ = render::Surface::mesh;
    std::optional<app::MeasureScene> measured_;
};

// Pixels that differ, in percent of a rectangle.
double changed_percent(const gl::Image& a, const gl::Image& b, const glm::ivec2& from, const glm::ivec2& to) {
    std::size_t changed = 0;
    for (int y = from.y; y < to.y; ++y)
        for (int x = from.x; x < to.x; ++x) {
            const auto at = static_cast<std::size_t>(3 * (y * kSize_px.x + x));
            changed +=
                a.rgb[at] != b.rgb[at] || a.rgb[at + 1] != b.rgb[at + 1] || a.rgb[at + 2] != b.rgb[at + 2];
        }
    return 100.0 * static_cast<double>(changed) / ((to.x - from.x) * (to.y - from.y));
}

}  // namespace

TEST_CASE("the horizon's panels show over the picture in their corners, and nowhere else") {
    test::GlContext gl;
    if (!gl) return;
    for (const auto mode : {select::HorizonMode::off, select::HorizonMode::ridges}) {
        // On a fast GPU four frames are over before the first tile has come.
        Walk walk(gl, mode, app::TileWait::settle);
        walk.show(7, app::Panel::hidden);
        const gl::Image without = walk.picture();
        walk.show(7, app::Panel::shown);
        const gl::Image with = walk.picture();
        // The map.
        CHECK(changed_percent(without, with, {480, 40}, {620, 180}) > 80.0);
        // The strip.
        CHECK(changed_percent(without, with, {310, 300}, {620, 380}) > 80.0);
        // The figures, and the middle of the picture.
        CHECK(changed_percent(without, with, {290, 60}, {440, 280}) == 0.0);
        std::size_t drawn = 0;
        for (const app::SceneNode& node : walk.horizon().nodes) drawn += node.report.drawn != 0;
        CHECK(drawn >= walk.stage().selection().draws.size());
        CHECK(walk.horizon().in_use == (mode == select::HorizonMode::ridges));
        // Level 0 is always there, so ground is known everywhere.
        for (const app::SceneNode& node : walk.horizon().nodes) CHECK(node.ground.cells > 0);
    }
}

TEST_CASE("the map shows the quadtree's cells: the land once, and of them those that are drawn") {
    test::GlContext gl;
    if (!gl) return;
    const gl::Image fates = [&] {
        Walk walk(gl, select::HorizonMode::ridges, app::TileWait::settle);
        walk.show(7, app::Panel::shown);
        return walk.picture();
    }();
    Walk walk(gl, select::HorizonMode::ridges, app::TileWait::settle, render::Surfaces::all);
    walk.show_levels(7);
    const gl::Image once = walk.picture();
    // Counted by the GPU itself, as of a frame ago.
    walk.show_levels(7);
    double area_m2 = 0.0;
    std::size_t drawn = 0, by_level = 0;
    for (const app::LevelCell& cell : walk.levels().cells) {
        area_m2 += static_cast<double>(cell.side_m.x) * static_cast<double>(cell.side_m.y);
        drawn += cell.in_view ? 1 : 0;
    }
    for (const std::uint32_t count : walk.levels().drawn) by_level += count;
    CHECK(by_level == drawn);
    // 1024 quads a side, in tiles of 32, whose roots may reach beyond.
    CHECK(area_m2 == doctest::Approx(1024.0 * 1024.0).epsilon(1e-6));
    constexpr std::size_t kTrianglesPerCell = 2 * 4 * 4;
    CHECK(walk.stage().frame().quadtree().counters().triangles == kTrianglesPerCell * drawn);
    CHECK(drawn > 50);
    CHECK(drawn < walk.levels().cells.size());
    CHECK(changed_percent(once, fates, {480, 40}, {620, 180}) > 60.0);
}

TEST_CASE("where there is no room for a line for each of the map's levels, one line shows them all") {
    test::GlContext gl;
    if (!gl) return;
    Walk walk(gl, select::HorizonMode::ridges, app::TileWait::settle, render::Surfaces::all);
    walk.show_levels(7);
    walk.show(7, app::Panel::hidden);
    const gl::Image without = walk.picture();
    walk.pretend_levels(12);
    walk.show_levels(7);
    const gl::Image with = walk.picture();
    CHECK(changed_percent(without, with, {450, 214}, {620, 230}) > 95.0);
    CHECK(changed_percent(without, with, {450, 240}, {620, 270}) == 0.0);
}

TEST_CASE("what is measured shows in its corner and on the ground, and costs no memory in steady state") {
    REQUIRE(telemetry::counts_heap_allocations());
    test::GlContext gl;
    if (!gl) return;
    count_imgui();
    Walk walk(gl, select::HorizonMode::off);
    for (int frame = 0; frame < 4; ++frame) walk.show(7, app::Panel::hidden);
    const gl::Image without = walk.picture();
    app::HeightProfile profile;
    for (int i = 0; i < 400; ++i) profile.push_back(20.0f + 15.0f * std::sin(0.05f * static_cast<float>(i)));
    profile[200] = std::nanf("");
    walk.measure(profile);
    // A panel that sizes itself shows from its second frame on.
    for (int frame = 0; frame < 2; ++frame) walk.show(7, app::Panel::hidden);
    const gl::Image with = walk.picture();
    CHECK(changed_percent(without, with, {220, 300}, {620, 460}) > 80.0);
    CHECK(changed_percent(without, with, {290, 60}, {440, 150}) == 0.0);
    std::uint64_t before = 0, imgui_before = 0;
    constexpr int kWarmUp = 20, kFrames = 60;
    for (int frame = 0; frame < kFrames; ++frame) {
        if (frame == kWarmUp) {
            before = telemetry::heap_allocations_of_this_thread();
            imgui_before = imgui_allocations;
        }
        walk.show(7, frame % 2 == 0 ? app::Panel::shown : app::Panel::hidden);
    }
    CHECK(telemetry::heap_allocations_of_this_thread() == before);
    CHECK(imgui_allocations == imgui_before);
}

TEST_CASE("walking with the horizon's panels allocates nothing in steady state") {
    REQUIRE(telemetry::counts_heap_allocations());
    test::GlContext gl;
    if (!gl) return;
    count_imgui();
    Walk walk(gl, select::HorizonMode::ridges);
    constexpr int kRound = 60, kRounds = 5;
    std::uint64_t before = 0, imgui_before = 0;
    for (int frame = 0; frame < kRounds * kRound; ++frame) {
        if (frame == (kRounds - 1) * kRound) {
            before = telemetry::heap_allocations_of_this_thread();
            imgui_before = imgui_allocations;
        }
        // Every range in every round, and off and on again.
        walk.show(frame, frame % kRound < 50 ? app::Panel::shown : app::Panel::hidden,
                  static_cast<app::MapRange>(frame / 10 % 4));
    }
    CHECK(telemetry::heap_allocations_of_this_thread() == before);
    CHECK(imgui_allocations == imgui_before);
    CHECK(imgui_before > 0);
}

TEST_CASE("the level map's legend names every level that is drawn, and no other, the finest first") {
    app::LevelScene scene;
    scene.finest_quad_m = 20.0f;
    for (std::size_t level = 1; level < scene.drawn.size(); ++level)
        if (level % 5 != 0) scene.drawn[level] = static_cast<std::uint32_t>(10 * level);
    std::array<app::LevelEntry, app::kMostLevelEntries> memory;
    const auto entries = app::legend_of(scene, memory);
    const auto drawn = std::ranges::count_if(scene.drawn, [](std::uint32_t count) { return count > 0; });
    REQUIRE(std::ssize(entries) == drawn);
    CHECK(drawn > 8);
    CHECK(std::ranges::is_sorted(entries, {}, &app::LevelEntry::quad_m));
    CHECK(entries.front().quad_m == 40.0f);
    CHECK(std::string_view(entries.front().name.data()) == "quads of 40 m");
    CHECK(entries.front().count == 10);
}
