#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <thread>
#include <vector>

#include "ridgeline/pager/fault.h"
#include "unit/pager_fixture.h"

namespace ridgeline::pager {
namespace {

using namespace std::chrono_literals;

// What a run of reads met: 'o' fine, 'e' an error, 'c' changed bytes.
std::string fates(const FaultSpec& spec, int reads, std::uint32_t frame = 0) {
    test::MemorySource memory;
    memory.bytes.resize(100);
    std::iota(memory.bytes.begin(), memory.bytes.end(), std::uint8_t{0});
    FaultySource faulty(memory, spec);
    faulty.advance(frame);
    std::string text;
    for (int i = 0; i < reads; ++i) {
        std::vector<std::uint8_t> bytes(100);
        const auto read = faulty.read(0, bytes);
        text += !read ? 'e' : bytes == memory.bytes ? 'o' : 'c';
    }
    return text;
}

long count(const std::string& text, char fate) { return std::count(text.begin(), text.end(), fate); }

}  // namespace

TEST_CASE("the fault text says what is meant") {
    const auto spec = parse_fault("delay=50ms,error=0.1,short-read=0.05,corrupt=0.01,seed=7,until=600");
    REQUIRE(spec);
    CHECK(spec->delay == 50ms);
    CHECK(spec->error == 0.1);
    CHECK(spec->short_read == 0.05);
    CHECK(spec->corrupt == 0.01);
    CHECK(spec->seed == 7);
    CHECK(spec->until_frame == 600);
    CHECK(spec->any());
    CHECK(parse_fault("delay=1.5s")->delay == 1500ms);
    CHECK(parse_fault("delay=20us")->delay == 20us);
    CHECK_FALSE(parse_fault("")->any());
    CHECK_FALSE(parse_fault("seed=3")->any());
}

TEST_CASE("wrong fault texts are refused in one line that names the part") {
    for (const char* text : {"delay=50",
                             "delay=ms",
                             "delay=-1ms",
                             "delay=2h",
                             "delay=99999s",
                             "error=1.5",
                             "error=-0.1",
                             "error=nan",
                             "error=",
                             "error",
                             "corrupt=x",
                             "seed=-1",
                             "seed=1.5",
                             "until=soon",
                             "noise=1",
                             "=",
                             ",",
                             "error=0.1,,seed=1",
                             "error=0.1,error=0.2",
                             "delay=50ms error=0.1"}) {
        CAPTURE(text);
        const auto spec = parse_fault(text);
        REQUIRE_FALSE(spec);
        // The part that is wrong comes first, which says what of the option it is.
        CHECK(spec.error().message.find(": ") != std::string::npos);
        CHECK(spec.error().message.find('\n') == std::string::npos);
    }
    CHECK(parse_fault("error=2").error().message == "error=2: give a probability from 0 to 1");
}

TEST_CASE("the seed decides which reads meet faults, at about the rates asked for") {
    FaultSpec spec;
    spec.error = 0.1;
    spec.short_read = 0.05;
    spec.corrupt = 0.2;
    const std::string fate = fates(spec, 10000);
    CHECK(fate == fates(spec, 10000));
    // 0.145 and 0.171 expected; four standard deviations are 0.014 and 0.015.
    CHECK(std::abs(count(fate, 'e') / 1e4 - 0.145) < 0.015);
    CHECK(std::abs(count(fate, 'c') / 1e4 - 0.171) < 0.016);
    spec.seed = 2;
    CHECK(fate != fates(spec, 10000));
}

TEST_CASE("reads are sound from the frame that was named") {
    FaultSpec spec;
    spec.error = 1.0;
    spec.until_frame = 5;
    CHECK(fates(spec, 3, 4) == "eee");
    CHECK(fates(spec, 3, 5) == "ooo");
}

TEST_CASE("an interrupt ends a delay under way and all later ones") {
    test::MemorySource memory;
    memory.bytes.resize(10);
    FaultSpec spec;
    spec.delay = 1h;
    FaultySource faulty(memory, spec);
    std::thread reader([&] {
        std::vector<std::uint8_t> bytes(10);
        CHECK_FALSE(faulty.read(0, bytes));
        CHECK_FALSE(faulty.read(0, bytes));
    });
    faulty.interrupt();
    reader.join();
}

}  // namespace ridgeline::pager
