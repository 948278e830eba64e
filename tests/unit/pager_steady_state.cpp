#include <doctest/doctest.h>

#include <vector>

#include "ridgeline/jobs/job_system.h"
#include "ridgeline/telemetry/allocation_counter.h"
#include "unit/pager_fixture.h"

namespace ridgeline::pager {

// The pager itself, without the fake renderer, whose checks allocate. Walks to and fro between two places,
// with a RAM cache that holds one of them, so that everything is read, decoded and evicted over and over.
TEST_CASE("paging allocates nothing once it has warmed up, on no thread") {
    REQUIRE(telemetry::counts_heap_allocations());
    test::FakeStore store({.imagery_width = 3000, .imagery_height = 2200});
    test::PatternDecoder decoder;
    jobs::JobSystem jobs({.workers = 2});
    const auto around = [&](double column, double row) {
        auto nodes = test::nodes_around(store.grid(), column, row, 2);
        for (const NodeIndex node : test::nodes_around(store.imagery_grid(), 3 * column, 3 * row, 1))
            nodes.push_back(store.tiles().begin(TileKind::imagery) + node);
        return nodes;
    };
    const std::vector<NodeIndex> places[2] = {around(200, 200), around(800, 600)};
    std::uint64_t bytes = 0;
    for (const NodeIndex node : places[0])
        bytes += RamRing::pages_for(store.source().decoded_bytes(node)) * RamRing::kPageBytes;
    auto pager = Pager::create(store.source(), jobs, {.ram_bytes = bytes * 5 / 4}, &decoder).value();
    REQUIRE(pager.load_level0());
    const std::uint64_t before_first_frame = telemetry::heap_allocations_of_this_thread();
    std::uint32_t frame = 0, slot = 0;
    const auto visit = [&](const std::vector<NodeIndex>& wanted) {
        do {
            ++frame;
            pager.begin_frame(frame, Seconds(frame / 60.0));
            for (const Upload& upload : pager.ready_to_upload(1 << 20))
                pager.mark_resident(upload.node, GpuSlot{++slot});
            pager.touch(std::span(wanted).first(1));
            pager.request(wanted);
            for (const TileKind kind : kEveryTileKind) pager.take_released_gpu_slots(kind);
        } while (!pager.settled());
    };
    // Warm is where queues and heaps have met their deepest moment, and which round that is depends on the
    // threads' timing: so rounds are walked until twenty in a row allocate nothing.
    std::uint64_t loaded = 0, evicted = 0, before = 0;
    int tries = 0;
    do {
        loaded = pager.counters().loaded;
        evicted = pager.counters().evicted;
        before = telemetry::heap_allocations();
        for (int round = 0; round < 20; ++round) visit(places[round % 2]);
    } while (telemetry::heap_allocations() != before && ++tries < 10);
    CHECK(telemetry::heap_allocations() == before);
    // The thread that draws never has to warm up.
    CHECK(telemetry::heap_allocations_of_this_thread() == before_first_frame);
    CHECK(pager.counters().loaded > loaded + 500);
    CHECK(pager.counters().evicted > evicted + 500);
}

}  // namespace ridgeline::pager
