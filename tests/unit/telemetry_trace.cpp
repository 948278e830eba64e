#include "ridgeline/telemetry/trace.h"

#include <doctest/doctest.h>

#include <atomic>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <thread>

#include "ridgeline/base/json_text.h"
#include "ridgeline/base/thread_role.h"

namespace ridgeline::telemetry {
namespace {

using Json = nlohmann::json;

// The events of one name.
std::vector<Json> events_named(const Trace& trace, const std::string& name) {
    const Json all = parse_json(trace.to_json());
    std::vector<Json> found;
    for (const Json& event : all.at("traceEvents"))
        if (event.at("name") == name) found.push_back(event);
    return found;
}

TEST_CASE("scopes become complete events with microseconds, nested as they were") {
    Trace trace;
    {
        const TraceScope outer(&trace, "outer \"quoted\"");
        const TraceScope inner(&trace, "inner");
    }
    const auto outer = events_named(trace, "outer \"quoted\"");
    const auto inner = events_named(trace, "inner");
    REQUIRE(outer.size() == 1);
    REQUIRE(inner.size() == 1);
    CHECK(outer[0].at("ph") == "X");
    CHECK(outer[0].at("ts").get<double>() >= 0.0);
    CHECK(outer[0].at("ts") <= inner[0].at("ts"));
    CHECK(outer[0].at("dur") >= inner[0].at("dur"));
    CHECK(outer[0].at("tid") == inner[0].at("tid"));
}

TEST_CASE("a scope without a trace does nothing") { const TraceScope scope(nullptr, "nothing"); }

TEST_CASE("spans keep their times, and values their value") {
    Trace trace;
    const auto now = now_ns();
    trace.add_span("span", now, 2'500'000);
    trace.add_value("value", 0.25);
    CHECK(events_named(trace, "span")[0].at("dur") == doctest::Approx(2500.0));
    const auto value = events_named(trace, "value")[0];
    CHECK(value.at("ph") == "C");
    CHECK(value.at("args").at("value") == 0.25);
}

TEST_CASE("a full ring keeps the newest events, in order") {
    Trace trace({.events_per_thread = 10});
    for (int number = 0; number < 37; ++number) trace.add_value("value", number);
    const auto values = events_named(trace, "value");
    REQUIRE(values.size() == 10);
    for (int place = 0; place < 10; ++place)
        CHECK(values[static_cast<std::size_t>(place)].at("args").at("value") == 27 + place);
}

TEST_CASE("each thread has a track of its own, named after the thread; reading while they record is safe") {
    Trace trace({.events_per_thread = 64});
    constexpr int kThreads = 3;
    std::vector<std::thread> threads;
    for (int thread = 0; thread < kThreads; ++thread) {
        threads.emplace_back([&trace, thread] {
            set_thread_role(ThreadRole::worker, ("tracer " + std::to_string(thread)).c_str());
            for (int event = 0; event < 500; ++event) const TraceScope scope(&trace, "work");
        });
    }
    for (int look = 0; look < 20; ++look) CHECK(!parse_json(trace.to_json()).is_discarded());
    for (auto& thread : threads) thread.join();
    std::set<std::string> names;
    for (const Json& event : events_named(trace, "thread_name")) names.insert(event.at("args").at("name"));
    CHECK(names == std::set<std::string>{"tracer 0", "tracer 1", "tracer 2"});
    std::map<int, int> events_of_track;
    for (const Json& event : events_named(trace, "work")) ++events_of_track[event.at("tid").get<int>()];
    CHECK(events_of_track.size() == kThreads);
    for (const auto& [track, events] : events_of_track) CHECK(events == 64);
}

TEST_CASE("a thread may use several traces, one after another and at once") {
    for (int round = 0; round < 3; ++round) {
        Trace first;
        Trace second;
        first.add_value("here", 1);
        second.add_value("there", 2);
        CHECK(events_named(first, "here").size() == 1);
        CHECK(events_named(first, "there").empty());
        CHECK(events_named(second, "there").size() == 1);
    }
}

}  // namespace
}  // namespace ridgeline::telemetry
