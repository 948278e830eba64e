// Where stores come to stand, and what is left when they do not: nothing.
#include <doctest/doctest.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <csignal>

#include "build_fixture.h"

using namespace ridgeline;
using namespace ridgeline::test;

namespace {

constexpr Case kSmall{300, 200, 33, true, 5};

Result<build::BuildReport> build_small(const std::filesystem::path& out,
                                       io::Replace replace = io::Replace::never) {
    MemoryRows rows = rows_of(kSmall);
    auto options = options_for(kSmall, out);
    options.replace = replace;
    return build::build_from_rows(rows, options);
}

}  // namespace

TEST_CASE("builder: a store that stands is replaced only when asked, and completely") {
    ScratchFolder folder;
    const auto out = folder.path() / "a.terrain";
    REQUIRE(build_small(out));
    const auto first = file_contents(out);
    CHECK_FALSE(build_small(out));
    std::ofstream(out / "terrain.json") << "{}";
    CHECK_FALSE(build_small(out));
    REQUIRE(build_small(out.string() + "/", io::Replace::existing));
    CHECK(file_contents(out) == first);
    CHECK(folder.entries() == std::vector<std::string>{"a.terrain"});
}

TEST_CASE("builder: what is no store is never replaced") {
    ScratchFolder folder;
    std::filesystem::create_directory(folder.path() / "folder");
    std::ofstream(folder.path() / "folder" / "letter.txt") << "dear";
    std::ofstream(folder.path() / "file") << "dear";
    for (const char* name : {"folder", "file"}) {
        const auto built = build_small(folder.path() / name, io::Replace::existing);
        REQUIRE_FALSE(built);
        CHECK(built.error().message.find("is no terrain") != std::string::npos);
    }
    CHECK(std::filesystem::exists(folder.path() / "folder" / "letter.txt"));
    CHECK(folder.entries().size() == 2);
}

TEST_CASE("builder: a folder that does not exist is an error that names it") {
    const auto built = build_small("/nonexistent/place/a.terrain");
    REQUIRE_FALSE(built);
    CHECK(built.error().message.find("/nonexistent/place") != std::string::npos);
}

TEST_CASE("builder: stopped at any stage, nothing is left and an older store stays") {
    ScratchFolder folder;
    const auto out = folder.path() / "a.terrain";
    REQUIRE(build_small(out));
    const auto first = file_contents(out);
    for (int stage = 0; stage < build::kStages; ++stage) {
        CAPTURE(stage);
        MemoryRows rows = rows_of(kSmall);
        std::atomic<bool> stop = false;
        auto options = options_for(kSmall, out);
        options.replace = io::Replace::existing;
        options.stop = &stop;
        options.progress = [&](build::Stage reached, std::int64_t, std::int64_t) {
            if (static_cast<int>(reached) >= stage) stop = true;
        };
        const auto built = build::build_from_rows(rows, options);
        REQUIRE_FALSE(built);
        CHECK(built.error().message.find("stopped") != std::string::npos);
        CHECK(folder.entries() == std::vector<std::string>{"a.terrain"});
        CHECK(file_contents(out) == first);
    }
}

TEST_CASE("builder: an error while reading ends the build with that error and leaves nothing") {
    ScratchFolder folder;
    // One row of this width fills a band, so that reading takes several.
    MemoryRows wide(3'000'000, 3,
                    [](std::int64_t x, std::int64_t) { return static_cast<std::int32_t>(x & 15); });
    wide.on_read = [](std::int64_t row) {
        return row > 0 ? Result<void>(Error{"dem.tif: cut off"}) : Result<void>();
    };
    const auto built = build::build_from_rows(wide, options_for(kSmall, folder.path() / "a.terrain"));
    REQUIRE_FALSE(built);
    CHECK(built.error().message == "dem.tif: cut off");
    CHECK(folder.entries().empty());
}

TEST_CASE("builder: a raster without any height is an error") {
    ScratchFolder folder;
    MemoryRows rows(100, 80, [](std::int64_t, std::int64_t) { return build::kNoHeight; });
    const auto built = build::build_from_rows(rows, options_for(kSmall, folder.path() / "a.terrain"));
    REQUIRE_FALSE(built);
    CHECK(built.error().message.find("nodata") != std::string::npos);
    CHECK(folder.entries().empty());
}

TEST_CASE("builder: on a full disk nothing is left, wherever it fills up") {
    ScratchFolder folder;
    int failures = 0;
    for (const rlim_t limit_bytes : {1'000u, 50'000u, 110'000u, 125'000u, 150'000u, 400'000u}) {
        CAPTURE(limit_bytes);
        const pid_t child = ::fork();
        REQUIRE(child >= 0);
        if (child == 0) {
            // Writing past the limit fails with EFBIG once the signal is ignored.
            ::signal(SIGXFSZ, SIG_IGN);
            const rlimit limit{limit_bytes, limit_bytes};
            ::setrlimit(RLIMIT_FSIZE, &limit);
            ::_exit(build_small(folder.path() / "a.terrain") ? 0 : 1);
        }
        int status = 0;
        REQUIRE(::waitpid(child, &status, 0) == child);
        REQUIRE(WIFEXITED(status));
        if (WEXITSTATUS(status) == 0) {
            CHECK(io::Store::open(folder.path() / "a.terrain"));
            std::filesystem::remove_all(folder.path() / "a.terrain");
        } else {
            ++failures;
        }
        CHECK(folder.entries().empty());
    }
    CHECK(failures >= 3);
}

TEST_CASE(
    "builder: what a killed build left is removed by the next of the same target, a living one's is not") {
    ScratchFolder folder;
    const auto out = folder.path() / "a.terrain";
    const pid_t child = ::fork();
    REQUIRE(child >= 0);
    if (child == 0) {
        MemoryRows rows = rows_of(kSmall);
        rows.on_read = [](std::int64_t) -> Result<void> { ::_exit(7); };
        (void)build::build_from_rows(rows, options_for(kSmall, out));
        ::_exit(0);
    }
    int status = 0;
    REQUIRE(::waitpid(child, &status, 0) == child);
    REQUIRE(WEXITSTATUS(status) == 7);
    CHECK(folder.entries().size() == 1);
    CHECK_FALSE(io::Store::open(folder.path() / folder.entries().front()));

    MemoryRows rows = rows_of(kSmall);
    std::vector<std::string> during;
    rows.on_read = [&](std::int64_t) -> Result<void> {
        REQUIRE(build_small(out));
        during = folder.entries();
        return Error{"enough"};
    };
    CHECK_FALSE(build::build_from_rows(rows, options_for(kSmall, out)));
    // The dead one's folder is gone; the living one's stood beside the finished store.
    CHECK(during.size() == 2);
    CHECK(folder.entries() == std::vector<std::string>{"a.terrain"});
}
