// The clock about GL's functions: it counts each call while it lives, and their time is part of the thread's.
#include "ridgeline/gl/call_clock.h"

#include <doctest/doctest.h>

#include <vector>

#include "ridgeline/gl/buffer.h"
#include "ridgeline/telemetry/clock.h"
#include "support/gl_context.h"

namespace ridgeline::gl {
namespace {

// Work of a driver's that takes a while, whatever it draws with.
void copy_much(Buffer& buffer, const std::vector<std::byte>& bytes) {
    buffer.write(0, bytes);
    glFinish();
}

TEST_CASE("calls are counted while a clock lives, and their time is within the thread's") {
    test::GlContext gl;
    if (!gl) return;
    if (!CallClock::available()) return;
    const std::vector<std::byte> bytes(16 << 20);
    auto buffer = Buffer::create({.size_bytes = bytes.size(), .use = BufferUse::update, .label = "much"});
    REQUIRE(buffer);
    const auto thread = telemetry::ThreadCpuClock::of_this_thread();
    for (int round = 0; round < 2; ++round) {
        const CallClock clock;
        CHECK(clock.calls() == 0);
        CHECK(clock.used_ns() == 0);
        const std::int64_t start_ns = thread.used_ns();
        glFlush();
        CHECK(clock.calls() == 1);
        copy_much(*buffer, bytes);
        const std::int64_t in_gl_ns = clock.used_ns(), all_ns = thread.used_ns() - start_ns;
        CHECK(clock.calls() >= 3);
        CHECK(in_gl_ns > 0);
        CHECK(in_gl_ns <= all_ns);
        // The program's own work is none of it.
        std::vector<int> values(1 << 20);
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<int>(i * 7919 % 104729);
        CHECK(values.back() >= 0);
        CHECK(clock.used_ns() == in_gl_ns);
    }
}

TEST_CASE("without a clock calls are made as ever") {
    test::GlContext gl;
    if (!gl) return;
    { const CallClock clock; }
    GLint units = 0;
    glGetIntegerv(GL_MAX_TEXTURE_IMAGE_UNITS, &units);
    CHECK(units >= 16);
    CHECK(glGetError() == GL_NO_ERROR);
}

}  // namespace
}  // namespace ridgeline::gl
