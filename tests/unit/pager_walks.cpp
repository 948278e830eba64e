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

// A place that drifts over the terrain and jumps now and then, and wants what lies about it: chunks, and the
// imagery among them.
class Wanderer {
  public:
    Wanderer(const FakeStore& store, unsigned seed)
        : grid_(store.grid()), tiles_(store.tiles()), random_(seed) {
        jump();
    }

    std::vector<NodeIndex> step() {
        if (random_() % 40 == 0) jump();
        column_ =
            std::clamp(column_ + 24.0 * std::cos(heading_), 0.0, static_cast<double>(grid_.width() - 1));
        row_ = std::clamp(row_ + 24.0 * std::sin(heading_), 0.0, static_cast<double>(grid_.height() - 1));
        const int radius = 1 + static_cast<int>(random_() % 3);
        const auto chunks = test::nodes_around(grid_, column_, row_, radius);
        return merged(chunks, imagery_around(radius));
    }

  private:
    std::vector<NodeIndex> imagery_around(int radius) const {
        const io::Grid& imagery = tiles_.grid(TileKind::imagery);
        if (imagery.levels() == 0) return {};
        const double scale = static_cast<double>(imagery.width()) / static_cast<double>(grid_.width());
        auto nodes = test::nodes_around(imagery, column_ * scale, row_ * scale, radius);
        for (NodeIndex& node : nodes) node += tiles_.begin(TileKind::imagery);
        return nodes;
    }
    // Either in its own order.
    std::vector<NodeIndex> merged(const std::vector<NodeIndex>& chunks,
                                  const std::vector<NodeIndex>& imagery) {
        std::vector<NodeIndex> all;
        std::size_t c = 0, i = 0;
        while (c < chunks.size() || i < imagery.size()) {
            const bool chunk = i == imagery.size() || (c < chunks.size() && random_() % 2 == 0);
            all.push_back(chunk ? chunks[c++] : imagery[i++]);
        }
        return all;
    }
    void jump() {
        column_ = static_cast<double>(random_() % static_cast<std::uint64_t>(grid_.width()));
        row_ = static_cast<double>(random_() % static_cast<std::uint64_t>(grid_.height()));
        heading_ = static_cast<double>(random_() % 628) / 100.0;
    }

    const io::Grid& grid_;
    const TileSpace tiles_;
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
    bool imagery = false;
};

// Walks, then stands still until all is settled. FakeRenderer checks every frame.
void walk(const Walk& walk) {
    CAPTURE(walk.seed);
    FakeStore store({.imagery_width = walk.imagery ? 3000 : 0, .imagery_height = walk.imagery ? 2200 : 0});
    PatternDecoder decoder;
    jobs::JobSystem jobs({.workers = walk.workers});
    PagerOptions options;
    options.ram_bytes = store.level0_bytes() + walk.ram_bytes;
    options.fault = walk.fault;
    auto pager = Pager::create(store.source(), jobs, options, &decoder).value();
    REQUIRE(pager.load_level0());
    FakeRenderer renderer(pager, store,
                          {.gpu_bytes = store.level0_bytes() + walk.gpu_bytes,
                           .gpu_imagery_bytes = store.level0_bytes() + walk.gpu_bytes / 2,
                           .upload_budget = 200'000});
    Wanderer wanderer(store, walk.seed);
    for (int frame = 0; frame < walk.frames; ++frame) renderer.frame(wanderer.step());
    const auto wanted = wanderer.step();
    REQUIRE(renderer.settle(wanted));
    const std::uint64_t everything = store.tile_bytes();
    if (walk.ram_bytes < everything || walk.gpu_bytes / 2 < everything) return;
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
    for (unsigned seed = 1; seed <= 24; ++seed)
        walk({.ram_bytes = (seed * seed % 150) << 14,
              .gpu_bytes = (seed * 5 % 13) << 15,
              .workers = 1 + static_cast<int>(seed % 3),
              .seed = seed,
              .imagery = seed % 2 == 0});
}

TEST_CASE(
    "with room for all, everything wanted becomes resident whatever the disk did, and nothing damaged is "
    "seen") {
    set_log_level(LogLevel::off);
    unsigned seed = 100;
    for (const char* fault : {"", "error=0.3", "short-read=0.3", "corrupt=0.3", "delay=1ms",
                              "error=0.2,short-read=0.1,corrupt=0.1,delay=200us", "error=1,until=200",
                              "corrupt=0.9,until=300", "", "corrupt=0.3", "error=0.2,short-read=0.1"}) {
        CAPTURE(fault);
        ++seed;
        Walk with_fault{.ram_bytes = 1 << 28,
                        .gpu_bytes = 1 << 28,
                        .workers = 1 + static_cast<int>(seed % 3),
                        .seed = seed,
                        .imagery = seed % 2 == 0};
        with_fault.fault = parse_fault(fault).value();
        walk(with_fault);
    }
    set_log_level(LogLevel::info);
}

TEST_CASE("small caches and a bad disk together") {
    set_log_level(LogLevel::off);
    for (unsigned seed = 200; seed < 212; ++seed) {
        Walk both{.ram_bytes = (seed % 7 + 1) << 17,
                  .gpu_bytes = (seed % 5 + 1) << 17,
                  .workers = 1 + static_cast<int>(seed % 3),
                  .seed = seed,
                  .imagery = seed % 2 == 0};
        both.fault = parse_fault("error=0.1,short-read=0.1,corrupt=0.1,delay=100us").value();
        walk(both);
    }
    set_log_level(LogLevel::info);
}

}  // namespace ridgeline::pager
