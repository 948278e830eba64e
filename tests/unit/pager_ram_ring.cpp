#include <doctest/doctest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "ridgeline/pager/ram_ring.h"

namespace ridgeline::pager {
namespace {

// Page by page, who has it: 0 nobody.
class NaivePages {
  public:
    explicit NaivePages(std::uint32_t count) : owner_(count, 0) {}

    void take(PageRun run, int owner) {
        for (std::uint32_t i = 0; i < run.pages; ++i) {
            REQUIRE(owner_[run.first_page + i] == 0);
            owner_[run.first_page + i] = owner;
        }
    }
    void give_back(PageRun run) { std::fill_n(owner_.begin() + run.first_page, run.pages, 0); }
    std::uint32_t used() const {
        return static_cast<std::uint32_t>(
            owner_.size() - static_cast<std::size_t>(std::count(owner_.begin(), owner_.end(), 0)));
    }
    std::uint32_t longest_free() const {
        std::uint32_t longest = 0, run = 0;
        for (const int owner : owner_) longest = std::max(longest, run = owner == 0 ? run + 1 : 0);
        return longest;
    }

  private:
    std::vector<int> owner_;
};

std::uint32_t random_size(std::mt19937& random, std::uint32_t most) {
    // Of every magnitude alike.
    const std::uint32_t below = 1u << (random() % 9);
    return std::min(most, 1 + static_cast<std::uint32_t>(random() % below));
}

}  // namespace

TEST_CASE("allocation succeeds exactly where a free run is long enough, and runs never overlap") {
    for (unsigned seed = 1; seed <= 40; ++seed) {
        std::mt19937 random(seed);
        const std::uint32_t count = 1 + random() % 700;
        auto pages = PageAllocator::create(count);
        REQUIRE(pages);
        NaivePages naive(count);
        std::vector<PageRun> held;
        // Tides of filling and emptying, so that full and fragmented states occur.
        for (int step = 0; step < 1500; ++step) {
            const bool filling = (step / 150) % 2 == 0;
            if (random() % 100 < (filling ? 75u : 25u)) {
                const std::uint32_t wanted = random_size(random, count);
                const std::uint32_t longest = naive.longest_free();
                const PageRun run = pages->allocate(wanted);
                REQUIRE(static_cast<bool>(run) == (wanted <= longest));
                if (!run) continue;
                REQUIRE(run.pages == wanted);
                REQUIRE(run.first_page + run.pages <= count);
                naive.take(run, step + 1);
                held.push_back(run);
            } else if (!held.empty()) {
                const std::size_t i = random() % held.size();
                pages->free(held[i]);
                naive.give_back(held[i]);
                held[i] = held.back();
                held.pop_back();
            }
            REQUIRE(pages->used_pages() == naive.used());
            REQUIRE(pages->largest_free_pages() == naive.longest_free());
        }
        for (const PageRun run : held) pages->free(run);
        CHECK(pages->used_pages() == 0);
        CHECK(pages->largest_free_pages() == count);
    }
}

TEST_CASE("the ring hands out its own memory, aligned to pages, and never more than it has") {
    auto ring = RamRing::create(10 * RamRing::kPageBytes + 100);
    REQUIRE(ring);
    CHECK(ring->capacity_bytes() == 10 * RamRing::kPageBytes);
    std::vector<std::span<std::byte>> blocks;
    for (const std::size_t size : {1, 4096, 4097, 12288}) {
        const RamBlock block = ring->allocate(size);
        REQUIRE(block);
        const auto bytes = ring->bytes(block);
        CHECK(bytes.size() >= size);
        CHECK(reinterpret_cast<std::uintptr_t>(bytes.data()) % RamRing::kPageBytes == 0);
        std::fill(bytes.begin(), bytes.end(), static_cast<std::byte>(blocks.size()));
        blocks.push_back(bytes);
    }
    for (std::size_t i = 0; i < blocks.size(); ++i)
        for (const std::byte byte : blocks[i]) REQUIRE(byte == static_cast<std::byte>(i));
    CHECK(ring->used_bytes() == 7 * RamRing::kPageBytes);
    CHECK_FALSE(ring->allocate(4 * RamRing::kPageBytes));
    CHECK(ring->allocate(3 * RamRing::kPageBytes));
    CHECK_FALSE(ring->allocate(1));
}

TEST_CASE("rings that cannot be are refused with a mend") {
    CHECK(RamRing::create(std::uint64_t{1} << 60).error().message.find("too large") != std::string::npos);
}

}  // namespace ridgeline::pager
