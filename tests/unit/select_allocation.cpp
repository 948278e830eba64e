// Selection allocates nothing in steady state. A program of its own, because it counts every operator new.
#include <doctest/doctest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "ridgeline/select/seen_ground.h"
#include "unit/select_scene.h"

namespace {
std::atomic<long> allocations{0};
}  // namespace

void* operator new(std::size_t bytes) {
    ++allocations;
    if (void* memory = std::malloc(bytes == 0 ? 1 : bytes)) return memory;
    std::abort();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace ridgeline::test {

TEST_CASE("a selection allocates nothing, from the first frame on") {
    const Scene scene({1100, 520, 32, 4});
    for (const char* name : {"screen_error", "distance", "roughness", "density"}) {
        const auto criterion = select::make_criterion(name).value();
        select::Selection selection(scene.info(), scene.records(), *criterion);
        Random random(1);
        const auto residency = all_resident(scene);
        const std::vector<io::NodeResidency> none(residency.size());
        // The finest view there is brings every list to its greatest length.
        auto finest = view_of_all(scene, random);
        finest.pixel_error_px = 1e-9;
        finest.sun.casters = select::CasterSet::all;
        finest.sun.reach_count = 1;
        std::vector<select::View> views{finest};
        for (int i = 0; i < 100; ++i) {
            views.push_back(random_view(scene, random));
            views.back().sun = finest.sun;
            views.back().sun.casters = static_cast<select::CasterSet>(i % 3);
            views.back().sun.axes =
                select::sun_axes(Angle::from_degrees(37.0 * i), Angle::from_degrees(1.0 + i % 80));
        }
        const long before = allocations;
        for (const auto& view : views) {
            selection.run(view, none);
            selection.run(view, residency);
        }
        CHECK(allocations == before);
    }
}

TEST_CASE("nor does one with the horizon, with tiles missing or not") {
    const Scene scene({.width = 600, .height = 520, .seed = 4, .relief = 2.0});
    const SceneGround ground(scene);
    const auto criterion = select::make_criterion("screen_error").value();
    select::Selection selection(scene.info(), scene.records(), *criterion);
    Random random(2);
    const auto all = all_resident(scene), some = random_residency(scene, random);
    auto finest = view_of_all(scene, random);
    finest.pixel_error_px = 1e-9;
    // Without a horizon the draw list is longest, with one what the horizon keeps.
    std::vector<select::View> views{finest};
    finest.horizon = select::HorizonMode::ridges;
    views.push_back(finest);
    for (int i = 0; i < 100; ++i) {
        views.push_back(random_view(scene, random));
        views.back().horizon = i % 3 == 0 ? select::HorizonMode::boxes : select::HorizonMode::ridges;
    }
    const long before = allocations;
    std::uint32_t hidden = 0;
    for (const auto& view : views) {
        hidden += selection.run(view, all, &ground).counters.horizon_culled;
        hidden += selection.run(view, some, &ground).counters.horizon_culled;
    }
    CHECK(allocations == before);
    CHECK(hidden > 0);
}

TEST_CASE("nor do a tile schedule and finding what is seen") {
    const Scene scene({.width = 300, .height = 180, .seed = 4});
    const auto criterion = select::make_criterion("screen_error").value();
    select::Selection selection(scene.info(), scene.records(), *criterion);
    const select::GroundBounds bounds(scene.info(), scene.records());
    select::SeenGround seen(scene.info(), bounds.terrain());
    select::TileSchedule schedule(select::heights_tree(scene.info(), scene.records()), bounds, 20);
    Random random(5);
    const auto residency = all_resident(scene);
    auto finest = view_of_all(scene, random);
    finest.pixel_error_px = 1e-9;
    selection.run(finest, residency);
    select::GroundReadback late;
    late.rectangle = bounds.terrain();
    const long before = allocations;
    std::uint32_t merges = schedule.run(seen.see(finest, {}, selection.result(), nullptr)).counters.merges;
    for (int i = 0; i < 100; ++i) {
        const auto view = random_view(scene, random);
        late.mask.clear(seen.lattice(), glm::dvec2(view.eye_m));
        late.mask.mark(bounds.terrain());
        const auto ground = seen.see(view, {}, selection.result(), i % 2 == 0 ? &late : nullptr);
        merges += schedule.run(ground).counters.merges;
    }
    CHECK(allocations == before);
    CHECK(merges > 0);
}

}  // namespace ridgeline::test
