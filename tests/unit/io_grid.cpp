#include <doctest/doctest.h>

#include <random>
#include <set>

#include "ridgeline/io/grid.h"

using namespace ridgeline::io;

TEST_CASE("grid: the shorter side takes one root, and nodes cover the raster and nothing else") {
    std::mt19937 random(1);
    for (int trial = 0; trial < 300; ++trial) {
        const int quads = 32 << (random() % 3);
        const std::int64_t width = 2 + random() % 5000, height = 2 + random() % 5000;
        const Grid grid(width, height, quads);
        CHECK(std::min(grid.nodes_x(0), grid.nodes_y(0)) == 1);
        CHECK((grid.levels() == 1 || grid.extent(1) < std::min(width, height) - 1));
        CHECK(grid.step(grid.finest()) == 1);
        for (int level = 0; level < grid.levels(); ++level) {
            CHECK(grid.nodes_x(level) * grid.extent(level) >= width - 1);
            CHECK((grid.nodes_x(level) - 1) * grid.extent(level) < width - 1);
            CHECK((grid.nodes_y(level) - 1) * grid.extent(level) < height - 1);
        }
    }
}

TEST_CASE("grid: linear order and its inverse agree, and every node's parent exists") {
    const Grid grid(1000, 333, 32);
    for (std::int64_t i = 0; i < grid.node_count(); ++i) {
        const NodeId node = grid.node_at(i);
        CHECK(grid.linear(node) == i);
        CHECK(grid.contains(node));
        if (node.level > 0) {
            CHECK(grid.contains(node.parent()));
            CHECK(node.parent().child(node.quarter()) == node);
        }
    }
}

TEST_CASE("hilbert: every place once, steps of one, siblings together") {
    constexpr int kOrder = 5, kSide = 1 << kOrder;
    std::vector<NodeId> places(kSide * kSide);
    std::set<std::uint64_t> seen;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const auto index = hilbert_index(x, y, kOrder);
            REQUIRE(index < places.size());
            seen.insert(index);
            places[index] = {0, x, y};
        }
    CHECK(seen.size() == places.size());
    for (std::size_t i = 1; i < places.size(); ++i) {
        CHECK(std::abs(places[i].x - places[i - 1].x) + std::abs(places[i].y - places[i - 1].y) == 1);
        if (i % 4 != 0)
            CHECK(NodeId{1, places[i].x, places[i].y}.parent() ==
                  NodeId{1, places[i - 1].x, places[i - 1].y}.parent());
    }
}
