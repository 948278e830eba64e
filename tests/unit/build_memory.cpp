// A build is refused before it reads where its memory cannot do, and does with what it asks for.
#include <doctest/doctest.h>

#include "build_fixture.h"
#include "ridgeline/build/build_memory.h"

using namespace ridgeline;
using namespace ridgeline::test;
using build::BuildShape;

namespace {

BuildShape square(std::int64_t side, bool may_have_nodata = true) {
    return {io::Grid(side, side, 64), may_have_nodata, 256};
}

constexpr Case kCase{700, 520, 33, true, 6};

}  // namespace

TEST_CASE("build memory: too little is refused before a row is read, and names what does") {
    const ScratchFolder folder;
    MemoryRows rows = rows_of(kCase);
    auto options = options_for(kCase, folder.path() / "a.terrain");
    const auto least = build::least_memory_bytes(
        {io::Grid(kCase.width, kCase.height, kCase.tile - 1), true, rows.natural_rows()});
    options.memory_bytes = least - 1;
    rows.on_read = [](std::int64_t) -> Result<void> { return Error{"a row was read"}; };
    const auto refused = build::build_from_rows(rows, options);
    REQUIRE_FALSE(refused);
    CHECK(refused.error().message.find("--memory " + std::to_string(least >> 20) + "MiB") !=
          std::string::npos);
    CHECK(folder.entries().empty());

    rows.on_read = {};
    options.memory_bytes = least;
    REQUIRE(build::build_from_rows(rows, options));
    auto generous = options_for(kCase, folder.path() / "b.terrain");
    REQUIRE(build::build_from_rows(rows, generous));
    CHECK(file_contents(options.out) == file_contents(generous.out));
}

TEST_CASE("build memory: grows with the raster, by a fraction of a byte a sample") {
    std::uint64_t before = 0;
    for (std::int64_t side = 2; side < 1'000'000; side = side * 3 + 1) {
        const std::uint64_t least = build::least_memory_bytes(square(side));
        CHECK(least >= before);
        CHECK(build::least_memory_bytes(square(side, false)) <= least);
        before = least;
    }
    const double samples = 100'000.0 * 100'000.0;
    CHECK(static_cast<double>(build::least_memory_bytes(square(100'000))) < 0.6 * samples);
    CHECK(static_cast<double>(build::least_memory_bytes(square(100'000, false))) > 0.15 * samples);
    CHECK_FALSE(build::affordable_threads(square(100'000), 1_GiB));
    CHECK(build::affordable_threads(square(40'000, false), 1_GiB));
}

TEST_CASE("build memory: threads follow what there is, and all of it keeps within") {
    constexpr std::uint64_t kThread = 24_MiB;
    for (const std::int64_t side : {2, 3000, 30'000}) {
        const BuildShape shape = square(side);
        const std::uint64_t least = build::least_memory_bytes(shape);
        CHECK(*build::affordable_threads(shape, least) == 2);
        int before = 2;
        for (std::uint64_t more = least; more < least + 40 * kThread; more += kThread) {
            const int threads = *build::affordable_threads(shape, more);
            CHECK(threads >= before);
            before = threads;
        }
        CHECK(before > 20);
    }
}
