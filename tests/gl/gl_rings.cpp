#include <doctest/doctest.h>

#include <cstring>
#include <numeric>
#include <random>
#include <vector>

#include "ridgeline/gl/readback_ring.h"
#include "ridgeline/gl/staging_ring.h"
#include "ridgeline/gl/timer_query.h"
#include "support/gl_context.h"

namespace ridgeline::gl {
namespace {

TEST_CASE("bytes pass through the staging ring unharmed while it goes round many times") {
    test::GlContext gl;
    if (!gl) return;
    constexpr std::size_t kSlots = 64;
    constexpr std::size_t kSlotBytes = 4096;
    auto ring = StagingRing::create(20'000);
    auto target = Buffer::create({.size_bytes = kSlots * kSlotBytes, .label = "target"});
    REQUIRE((ring && target));
    CHECK(ring->size_bytes() % StagingRing::kAlignment == 0);
    std::vector<std::byte> expected(kSlots * kSlotBytes);
    target->clear(0);
    std::mt19937 random(2);
    int uploads = 0;
    for (int frame = 0; frame < 300; ++frame) {
        ring->begin_frame();
        for (int i = 0; i < 4; ++i) {
            const std::size_t bytes = 4 * (1 + random() % (kSlotBytes / 4));
            const auto staged = ring->allocate(bytes);
            if (!staged) continue;
            const std::size_t at = random() % kSlots * kSlotBytes;
            for (auto& byte : staged->bytes) byte = static_cast<std::byte>(random());
            std::memcpy(expected.data() + at, staged->bytes.data(), bytes);
            copy(ring->buffer(), staged->offset_bytes, *target, at, bytes);
            ++uploads;
        }
        ring->end_frame();
        glFlush();
    }
    CHECK(uploads > 300);
    std::vector<std::byte> found(expected.size());
    glGetNamedBufferSubData(target->id(), 0, static_cast<GLsizeiptr>(found.size()), found.data());
    CHECK(found == expected);
}

TEST_CASE("a full staging ring says so and is free again once the GPU is done") {
    test::GlContext gl;
    if (!gl) return;
    auto ring = StagingRing::create(4096);
    REQUIRE(ring);
    CHECK_FALSE(ring->allocate(4097));
    REQUIRE(ring->allocate(4096));
    CHECK_FALSE(ring->allocate(1));
    ring->end_frame();
    glFinish();
    ring->begin_frame();
    CHECK(ring->used_bytes() == 0);
    CHECK(ring->allocate(4096));
}

TEST_CASE("frames beyond the fences in flight are freed with a later frame") {
    test::GlContext gl;
    if (!gl) return;
    auto ring = StagingRing::create(1 << 20);
    REQUIRE(ring);
    for (int frame = 0; frame < 30; ++frame) {
        REQUIRE(ring->allocate(256));
        ring->end_frame();
    }
    glFinish();
    ring->begin_frame();
    REQUIRE(ring->allocate(256));
    ring->end_frame();
    glFinish();
    ring->begin_frame();
    CHECK(ring->used_bytes() == 0);
}

TEST_CASE("readbacks arrive in order with their tags and bytes, and are refused when no slot is free") {
    test::GlContext gl;
    if (!gl) return;
    auto ring = ReadbackRing::create({.slot_bytes = 8, .slots = 3});
    auto source = Buffer::create({.size_bytes = 8, .use = BufferUse::update, .label = "source"});
    REQUIRE((ring && source));
    std::uint64_t next_tag = 0;
    std::uint64_t requested = 0;
    const auto take_all = [&] {
        while (const auto arrived = ring->take()) {
            std::uint64_t value = 0;
            REQUIRE(arrived->bytes.size() == 8);
            std::memcpy(&value, arrived->bytes.data(), 8);
            CHECK(arrived->tag == next_tag);
            CHECK(value == next_tag * 1000);
            ++next_tag;
        }
    };
    for (int frame = 0; frame < 200; ++frame) {
        take_all();
        const std::uint64_t value = requested * 1000;
        source->write(0, bytes_of(value));
        const bool room = ring->in_flight() < 3;
        const bool accepted = ring->request(*source, 0, 8, requested) == ReadbackRing::Accepted::yes;
        CHECK(accepted == room);
        requested += accepted ? 1 : 0;
        if (frame % 5 == 0) glFinish();
    }
    glFinish();
    take_all();
    CHECK(next_tag == requested);
    CHECK(requested > 50);
}

TEST_CASE("pixels are read back as they were drawn") {
    test::GlContext gl;
    if (!gl) return;
    const auto target = RenderTarget::create({.size_px = {16, 8}, .color_format = GL_RG32UI});
    REQUIRE(target);
    const GLuint color[] = {77, 88, 0, 0};
    glClearNamedFramebufferuiv(target->framebuffer.id(), GL_COLOR, 0, color);
    auto ring = ReadbackRing::create({.slot_bytes = 16 * 8 * 8});
    REQUIRE(ring);
    const ReadbackRing::PixelRegion region{.framebuffer = target->framebuffer.id(),
                                           .size_px = {16, 8},
                                           .format = GL_RG_INTEGER,
                                           .type = GL_UNSIGNED_INT,
                                           .size_bytes = 16 * 8 * 8};
    REQUIRE(ring->request(region, 5) == ReadbackRing::Accepted::yes);
    glFinish();
    const auto arrived = ring->take();
    REQUIRE(arrived);
    std::vector<GLuint> values(16 * 8 * 2);
    std::memcpy(values.data(), arrived->bytes.data(), arrived->bytes.size());
    for (std::size_t i = 0; i < values.size(); ++i) CHECK(values[i] == color[i % 2]);
}

TEST_CASE("timers give one time for each measured frame, in order, and may nest") {
    test::GlContext gl;
    if (!gl) return;
    TimerQuery outer = TimerQuery::create(4);
    TimerQuery inner = TimerQuery::create(4);
    auto buffer = Buffer::create({.size_bytes = 1 << 20, .label = "work"});
    REQUIRE(buffer);
    std::uint64_t next = 0;
    for (std::uint64_t frame = 0; frame < 20; ++frame) {
        outer.begin(frame);
        inner.begin(frame);
        buffer->clear(static_cast<std::uint32_t>(frame));
        inner.end();
        outer.end();
        glFinish();
        while (const auto measured = outer.take()) {
            CHECK(measured->frame == next++);
            CHECK(measured->time.count() >= 0.0);
        }
        while (inner.take()) {
        }
    }
    CHECK(next == 20);
    // Nobody takes: the fifth and later go unmeasured, and nothing waits.
    for (std::uint64_t frame = 20; frame < 30; ++frame) {
        outer.begin(frame);
        outer.end();
    }
    glFinish();
    while (const auto measured = outer.take()) CHECK(measured->frame == next++);
    CHECK(next == 24);
}

}  // namespace
}  // namespace ridgeline::gl
