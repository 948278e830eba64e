#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "ridgeline/base/log.h"
#include "ridgeline/jobs/job_system.h"
#include "unit/pager_fixture.h"

namespace ridgeline::pager {
namespace {

using test::FakeRenderer;
using test::FakeStore;
using test::PatternDecoder;

// A place that drifts over the terrain and jumps now and then.
class Wanderer {
  public:
    Wanderer(const io::Grid& grid, unsigned seed) : grid_(grid), random_(seed) { jump(); }

    std::vector<NodeIndex> step() {
        if (random_() % 40 == 0) jump();
        column_ =
            std::clamp(column_ + 24.0 * std::cos(heading_), 0.0, static_cast<double>(grid_.width() - 1));
        row_ = std::clamp(row_ + 24.0 * std::sin(heading_), 0.0, static_cast<double>(grid_.height() - 1));
        return test::nodes_around(grid_, column_, row_, 1 + static_cast<int>(random_() % 3));
    }

  private:
    void jump() {
        column_ = static_cast<double>(random_() % static_cast<std::uint64_t>(grid_.width()));
        row_ = static_cast<double>(random_() % static_cast<std::uint64_t>(grid_.height()));
        heading_ = static_cast<double>(random_() % 628) / 100.0;
    }

    const io::Grid& grid_;
    std::mt19937 random_;
    double column_ = 0.0, row_ = 0.0, heading_ = 0.0;
};

struct Walk {
    std::uint64_t ram_bytes = 0;  // beyond level 0
    std::uint64_t gpu_bytes = 0;
    FaultSpec fault{};
    int workers = 1;
    int frames = 400;
    unsigned seed = 1;
};

std::uint64_t level0_bytes(const FakeStore& store) {
    std::uint64_t bytes = 0;
    for (std::int64_t i = 0; i < store.grid().first(1); ++i)
        bytes += RamRing::pages_for(io::chunk_layout(store.records[static_cast<std::size_t>(i)],
                                                     {.quads = store.grid().quads()})
                                        .total) *
                 RamRing::kPageBytes;
    return bytes;
}

// Walks, then stands still until all is settled. FakeRenderer checks every frame.
void walk(const Walk& walk) {
    CAPTURE(walk.seed);
    FakeStore store;
    PatternDecoder decoder;
    jobs::JobSystem jobs({.workers = walk.workers});
    PagerOptions options;
    options.ram_bytes = level0_bytes(store) + walk.ram_bytes;
    options.fault = walk.fault;
    auto pager = Pager::create(store.source(), jobs, options, &decoder).value();
    REQUIRE(pager.load_level0());
    FakeRenderer renderer(pager, store,
                          {.gpu_bytes = level0_bytes(store) + walk.gpu_bytes, .upload_budget = 200'000});
    Wanderer wanderer(store.grid(), walk.seed);
    for (int frame = 0; frame < walk.frames; ++frame) renderer.frame(wanderer.step());
    const auto wanted = wanderer.step();
    REQUIRE(renderer.settle(wanted));
    const std::uint64_t everything = store.chunk_bytes();
    if (walk.ram_bytes < everything || walk.gpu_bytes < everything) return;
    for (int tries = 0; tries < 100; ++tries) {
        if (std::all_of(wanted.begin(), wanted.end(),
                        [&](NodeIndex node) { return renderer.resident(node); }))
            return;
        // Settled with failures: two seconds on, they are tried again.
        for (int frame = 0; frame < 130; ++frame) renderer.frame(wanted);
        REQUIRE(renderer.settle(wanted));
    }
    FAIL("not everything wanted became resident");
}

}  // namespace

TEST_CASE("caches keep their bytes and what is drawn, however small they are") {
    for (unsigned seed = 1; seed <= 12; ++seed)
        walk({.ram_bytes = (seed * seed) << 14,
              .gpu_bytes = (seed * 5 % 13) << 15,
              .workers = 1 + static_cast<int>(seed % 3),
              .seed = seed});
}

TEST_CASE(
    "with room for all, everything wanted becomes resident whatever the disk did, and nothing damaged is "
    "seen") {
    set_log_level(LogLevel::off);
    unsigned seed = 100;
    for (const char* fault :
         {"", "error=0.3", "short-read=0.3", "corrupt=0.3", "delay=1ms",
          "error=0.2,short-read=0.1,corrupt=0.1,delay=200us", "error=1,until=200", "corrupt=0.9,until=300"}) {
        CAPTURE(fault);
        ++seed;
        Walk with_fault{.ram_bytes = 1 << 28,
                        .gpu_bytes = 1 << 28,
                        .workers = 1 + static_cast<int>(seed % 3),
                        .seed = seed};
        with_fault.fault = parse_fault(fault).value();
        walk(with_fault);
    }
    set_log_level(LogLevel::info);
}

TEST_CASE("small caches and a bad disk together") {
    set_log_level(LogLevel::off);
    for (unsigned seed = 200; seed < 206; ++seed) {
        Walk both{.ram_bytes = (seed % 7 + 1) << 17,
                  .gpu_bytes = (seed % 5 + 1) << 17,
                  .workers = 1 + static_cast<int>(seed % 3),
                  .seed = seed};
        both.fault = parse_fault("error=0.1,short-read=0.1,corrupt=0.1,delay=100us").value();
        walk(both);
    }
    set_log_level(LogLevel::info);
}

}  // namespace ridgeline::pager
