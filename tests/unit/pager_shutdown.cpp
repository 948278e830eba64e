#include <doctest/doctest.h>

#include <chrono>
#include <vector>

#include "ridgeline/jobs/job_system.h"
#include "unit/pager_fixture.h"

namespace ridgeline::pager {

using namespace std::chrono_literals;

// The promise itself is one of time; a delay of an hour makes the difference between kept and broken
// unmistakable.
TEST_CASE("shutting down does not wait for an injected delay") {
    test::FakeStore store;
    test::PatternDecoder decoder;
    jobs::JobSystem jobs({.workers = 2});
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < 5; ++i) {
        PagerOptions options;
        options.fault.delay = 1h;
        auto pager = Pager::create(store.source(), jobs, options, &decoder).value();
        REQUIRE(pager.load_level0());
        test::FakeRenderer renderer(pager, store, {});
        const auto wanted = test::nodes_around(store.grid(), 500, 500, 3);
        for (int frame = 0; frame < i; ++frame) renderer.frame(wanted);
    }
    CHECK(std::chrono::steady_clock::now() - start < 10min);
}

TEST_CASE("shutting down in the middle of work leaves nothing behind, with any number of workers") {
    test::FakeStore store;
    test::PatternDecoder decoder;
    for (int trial = 0; trial < 60; ++trial) {
        jobs::JobSystem jobs({.workers = 1 + trial % 3});
        PagerOptions options;
        options.fault.error = 0.2;
        auto pager = Pager::create(store.source(), jobs, options, &decoder).value();
        REQUIRE(pager.load_level0());
        test::FakeRenderer renderer(pager, store, {});
        const auto wanted = test::nodes_around(store.grid(), 500, 500, 3);
        for (int frame = 0; frame < trial; ++frame) renderer.frame(wanted);
    }
}

}  // namespace ridgeline::pager
