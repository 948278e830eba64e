// The watch over a long walk: it tells what rises from what only scatters, and can fail.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>

#include "ridgeline/app/walk/soak_watch.h"

using namespace ridgeline;
using namespace ridgeline::app;

namespace {

using Fill = std::function<void(telemetry::FrameRecord& frame, double time_s)>;

// Eight frames a second, each of a millisecond and a half of CPU time.
SoakWatch watched(int seconds, const Fill& fill) {
    SoakWatch watch({}, static_cast<std::size_t>(seconds));
    for (int frame = 1; frame <= 8 * seconds; ++frame) {
        telemetry::FrameRecord record;
        record.frame_ms = frame % 8 == 0 ? 250.0 : 90.0;
        record.rss_bytes = 400'000'000;
        record.gpu_cache_bytes = 100'000'000;
        record.handles = 21;
        const double time_s = 0.125 * frame;
        fill(record, time_s);
        watch.add({time_s, 0.0015 * frame}, record);
    }
    return watch;
}

}  // namespace

TEST_CASE("soak: a walk that stays as it is passes, and its means are those of its frames") {
    const SoakWatch watch = watched(120, [](telemetry::FrameRecord&, double) {});
    CHECK(watch.seconds().size() == 120);
    CHECK(watch.verdict());
    const SoakWatch::Second& second = watch.seconds().back();
    CHECK(second.frames == 8);
    CHECK(second.frame_ms == doctest::Approx(125.0));
    CHECK(second.frame_ms_max == 250.0);
    CHECK(second.cpu_ms == doctest::Approx(1.5));
    const auto table = watch.table();
    REQUIRE(table);
    CHECK(std::count(table->begin(), table->end(), '\n') == 6);
    CHECK(table->find("rises") == std::string::npos);
    const std::string csv = watch.csv();
    CHECK(std::count(csv.begin(), csv.end(), '\n') == 121);
    CHECK(csv.starts_with("wall_s,frames,rss_bytes,"));
}

TEST_CASE("soak: what fills caches at the start is warming up; what goes on filling fails, by name") {
    const auto grows = [](double until_s) {
        return [until_s](telemetry::FrameRecord& frame, double time_s) {
            frame.rss_bytes += static_cast<std::int64_t>(50'000.0 * std::min(time_s, until_s));
        };
    };
    CHECK(watched(600, grows(140.0)).verdict());
    const auto leaks = watched(600, grows(600.0)).verdict();
    REQUIRE(!leaks);
    CHECK(leaks.error().message.find("rss_bytes rises by 171.7 MiB an hour") != std::string::npos);
    // One file a minute that nobody closes.
    const auto open = watched(600, [](telemetry::FrameRecord& frame, double time_s) {
                          frame.handles += static_cast<std::int64_t>(time_s / 60.0);
                      }).verdict();
    REQUIRE(!open);
    CHECK(open.error().message.find("handles") != std::string::npos);
}

TEST_CASE("soak: a leak of one page a second is told from noise a hundred times larger") {
    std::mt19937 random(7);
    const auto noise = [&] { return static_cast<std::int64_t>(random() % 400'000); };
    CHECK(watched(600, [&](telemetry::FrameRecord& frame, double) { frame.rss_bytes += noise(); }).verdict());
    const auto leaks = watched(600, [&](telemetry::FrameRecord& frame, double time_s) {
                           frame.rss_bytes += noise() + static_cast<std::int64_t>(4096.0 * time_s);
                       }).verdict();
    CHECK(!leaks);
}

TEST_CASE("soak: too short a walk says so instead of passing") {
    const auto verdict = watched(20, [](telemetry::FrameRecord&, double) {}).verdict();
    REQUIRE(!verdict);
    CHECK(verdict.error().message.find("too few") != std::string::npos);
}
