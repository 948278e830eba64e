#include <doctest/doctest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "ridgeline/pager/read_group.h"

namespace ridgeline::pager {
namespace {

// Payloads back to back in both files, with random sizes; in random order of urgency.
std::vector<ReadCandidate> random_candidates(std::mt19937& random, int count, int keep_one_in) {
    std::vector<ReadCandidate> all;
    std::uint64_t mesh = 1000, heights = 5000;
    for (int i = 0; i < count; ++i) {
        const std::uint64_t mesh_size = 1 + random() % 5000, heights_size = random() % 3000;
        if (random() % static_cast<unsigned>(keep_one_in) == 0)
            all.push_back({0, {{mesh, mesh + mesh_size}, {heights, heights + heights_size}}});
        mesh += mesh_size;
        heights += heights_size;
    }
    std::shuffle(all.begin(), all.end(), random);
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i].index = i;
    return all;
}

ReadRanges whole(std::span<const ReadCandidate> group) {
    ReadRanges ranges;
    for (const ReadCandidate& member : group) ranges = ranges.joined(member.ranges);
    return ranges;
}

}  // namespace

TEST_CASE("a group holds the most urgent request, keeps its limits, and comes in order of urgency") {
    std::mt19937 random(3);
    std::size_t largest = 0;
    for (int trial = 0; trial < 500; ++trial) {
        auto candidates = random_candidates(random, 1 + static_cast<int>(random() % 300),
                                            1 + static_cast<int>(random() % 20));
        if (candidates.empty()) continue;
        ReadLimits limits;
        limits.max_read_bytes = 1 + random() % 200000;
        limits.max_gap_bytes = random() % 40000;
        limits.max_members = 1 + random() % 40;
        const auto group = choose_group(candidates, limits);
        REQUIRE(!group.empty());
        REQUIRE(group.size() <= limits.max_members);
        REQUIRE(group.front().index == 0);
        for (std::size_t i = 1; i < group.size(); ++i) REQUIRE(group[i - 1].index < group[i].index);
        const ReadRanges ranges = whole(group);
        if (group.size() > 1) {
            REQUIRE(ranges.first.bytes() <= limits.max_read_bytes);
            REQUIRE(ranges.second.bytes() <= limits.max_read_bytes);
        }
        largest = std::max(largest, group.size());
    }
    CHECK(largest > 10);
}

TEST_CASE("siblings that lie together are read together, whatever else is wanted in between in urgency") {
    std::vector<ReadCandidate> candidates;
    for (std::uint32_t i = 0; i < 8; ++i) {
        // Two families of four, far apart; their members alternate in urgency.
        const std::uint64_t at = (i % 2) * 10'000'000 + (i / 2) * 2000;
        candidates.push_back({i, {{at, at + 2000}, {at, at + 2000}}});
    }
    const auto group = choose_group(candidates, {});
    REQUIRE(group.size() == 4);
    for (std::uint32_t i = 0; i < 4; ++i) CHECK(group[i].index == 2 * i);
}

TEST_CASE("chunks that are neighbours in one file only are not read together") {
    std::vector<ReadCandidate> candidates = {{0, {{0, 100}, {0, 100}}},
                                             {1, {{100, 200}, {1'000'000, 1'000'100}}}};
    CHECK(choose_group(candidates, {}).size() == 1);
}

TEST_CASE("a payload larger than a read may be is read alone") {
    std::vector<ReadCandidate> candidates = {{0, {{0, 1'000'000}, {0, 10}}},
                                             {1, {{1'000'000, 1'000'010}, {10, 20}}}};
    CHECK(choose_group(candidates, {}).size() == 1);
}

}  // namespace ridgeline::pager
