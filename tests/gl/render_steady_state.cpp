// A walk in steady state takes no memory from the heap: everything is sized at the start.
#include <chrono>
#include <thread>

#include "gl/render_scene.h"
#include "ridgeline/telemetry/allocation_counter.h"
#include "support/small_imagery.h"

using namespace ridgeline;
using namespace ridgeline::test;

namespace {

enum class Scheduled { nothing, heights, imagery, disc, quadtree, made };

void cover_with_imagery(const std::filesystem::path& store) {
    const auto info = io::read_terrain_info(store);
    REQUIRE(info);
    MemoryTexels texels(frame_over(*info, 4), [](std::int64_t x, std::int64_t y) {
        return build::Texel{static_cast<std::uint8_t>(x / 4), static_cast<std::uint8_t>(y / 4), 90,
                            build::kOpaque};
    });
    add_imagery(store, texels);
}

void walk_in_circles(select::CasterSet shadows, Scheduled scheduled) {
    REQUIRE(telemetry::counts_heap_allocations());
    SceneOptions options;
    options.width = options.height = 1025;
    options.stage.frame.size_px = {200, 150};
    options.stage.frame.gpu_cache_bytes = 1_MiB;
    options.stage.pager.ram_bytes = 1_MiB;
    if (scheduled == Scheduled::imagery) {
        options.finish_store = cover_with_imagery;
        options.stage.pager.ram_bytes = 3_MiB;
    }
    if (scheduled == Scheduled::made) options.stage.frame.detail_octaves = 2;
    if (scheduled == Scheduled::disc || scheduled == Scheduled::quadtree || scheduled == Scheduled::made) {
        options.stage.frame.surfaces = render::Surfaces::all;
        options.stage.frame.gpu_cache_bytes = 2_MiB;
        options.stage.pager.ram_bytes = 2_MiB;
    }
    options.stage.frame.shadow_map_px = 128;
    options.stage.shadows = shadows;
    RenderScene scene(options);
    if (scheduled == Scheduled::heights) {
        options.stage.scheduled =
            select::ScheduledTexture{select::heights_tree(scene.info(), scene.store().records()), 30};
        scene.open(options.stage);
    }
    app::StageMoment moment;
    moment.camera.lens.size_px = {200, 150};
    if (scheduled == Scheduled::disc) moment.surface = render::Surface::disc;
    if (scheduled == Scheduled::quadtree) moment.surface = render::Surface::quadtree;
    const pager::Pager& pager = scene.stage().pager();
    // Round and round; only in the first may the driver make what it makes once. A round in which nothing
    // came and went would prove little and counts for nothing. Frames are paced as a display does it: a fast
    // GPU would be round before the disk has answered, and so cancel what it asked for.
    constexpr int kRound = 60, kRounds = 5, kMostRounds = 200;
    constexpr std::chrono::milliseconds kPace{4};
    std::uint64_t before = 0;
    int frame = 0, rounds = 0;
    for (int tries = 0; rounds < kRounds && tries < kMostRounds; ++tries) {
        const std::uint64_t evicted = pager.counters().evicted;
        for (const int end = frame + kRound; frame < end; ++frame) {
            const double angle = 6.283185307 * frame / kRound;
            moment.now = pager::Seconds(frame / 60.0);
            moment.daylight = {Angle::from_degrees(6.0 * frame), Angle::from_degrees(5.0 + frame % kRound)};
            moment.camera.pose = {scene.place(512 + 400 * std::cos(angle), 512 + 400 * std::sin(angle), 75.0),
                                  Angle::from_radians(angle), Angle::from_degrees(-20.0)};
            const auto next_frame = std::chrono::steady_clock::now() + kPace;
            scene.stage().show(moment);
            std::this_thread::sleep_until(next_frame);
        }
        if (tries == 0) before = telemetry::heap_allocations_of_this_thread();
        const bool imagery_went =
            scheduled != Scheduled::imagery || pager.counters(pager::TileKind::imagery).evicted > 0;
        rounds += pager.counters().evicted > evicted && imagery_went;
    }
    CHECK(telemetry::heap_allocations_of_this_thread() == before);
    CHECK(rounds == kRounds);
}

}  // namespace

TEST_CASE("Frames in steady state allocate nothing, while chunks come and go") {
    GlContext gl;
    if (!gl) return;
    for (const auto shadows : {select::CasterSet::none, select::CasterSet::pvs, select::CasterSet::all}) {
        CAPTURE(static_cast<int>(shadows));
        walk_in_circles(shadows, Scheduled::nothing);
    }
}

TEST_CASE("Nor do they where a texture's tiles are scheduled by the ground read back") {
    GlContext gl;
    if (!gl) return;
    walk_in_circles(select::CasterSet::none, Scheduled::heights);
}

TEST_CASE("Nor do they while the disc's heights come and go") {
    GlContext gl;
    if (!gl) return;
    walk_in_circles(select::CasterSet::none, Scheduled::disc);
}

TEST_CASE("Nor while those of the quadtree do") {
    GlContext gl;
    if (!gl) return;
    walk_in_circles(select::CasterSet::none, Scheduled::quadtree);
}

TEST_CASE("Nor while the mesh gives way to made ground, here and there") {
    GlContext gl;
    if (!gl) return;
    walk_in_circles(select::CasterSet::none, Scheduled::made);
}

TEST_CASE("Nor do they while imagery comes and goes") {
    GlContext gl;
    if (!gl) return;
    walk_in_circles(select::CasterSet::none, Scheduled::imagery);
}
