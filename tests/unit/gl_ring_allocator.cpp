#include <doctest/doctest.h>

#include <deque>
#include <random>

#include "ridgeline/gl/ring_allocator.h"

namespace ridgeline::gl {
namespace {

TEST_CASE("allocations in use never overlap, stay inside the ring, and are aligned") {
    constexpr std::uint64_t kSize = 4096;
    std::mt19937_64 random(11);
    RingAllocator ring(kSize);
    struct Live {
        std::uint64_t begin, end, position;
    };
    std::deque<Live> live;
    int refused = 0;
    for (int i = 0; i < 100'000; ++i) {
        const std::uint64_t bytes = 1 + random() % 1500;
        const std::uint64_t alignment = std::uint64_t{1} << (random() % 9);
        const auto offset = ring.allocate(bytes, alignment);
        if (offset) {
            CHECK(*offset % alignment == 0);
            CHECK(*offset + bytes <= kSize);
            for (const auto& other : live) CHECK((*offset + bytes <= other.begin || other.end <= *offset));
            live.push_back({*offset, *offset + bytes, ring.position()});
        } else {
            ++refused;
        }
        if (!live.empty() && (!offset || random() % 2 == 0)) {
            ring.release(live.front().position);
            live.pop_front();
        }
    }
    CHECK(refused > 1000);
    CHECK(refused < 90'000);
}

TEST_CASE("a full ring refuses, and a released one is empty") {
    RingAllocator ring(1024);
    CHECK(ring.allocate(1024, 256) == 0);
    CHECK_FALSE(ring.allocate(1, 1));
    CHECK(ring.used_bytes() == 1024);
    ring.release(ring.position());
    CHECK(ring.used_bytes() == 0);
    CHECK_FALSE(ring.allocate(1025, 1));
}

TEST_CASE("an empty ring takes whatever fits in it, wherever it stands") {
    std::mt19937_64 random(12);
    RingAllocator ring(2048);
    for (int i = 0; i < 1000; ++i) {
        REQUIRE(ring.allocate(1 + random() % 700, 1));
        ring.release(ring.position());
        REQUIRE(ring.allocate(2048, 256));
        ring.release(ring.position());
    }
}

}  // namespace
}  // namespace ridgeline::gl
