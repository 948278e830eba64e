#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "ridgeline/pager/victims.h"

namespace ridgeline::pager {
namespace {

// A store of a few levels whose nodes are all on the GPU, used in no frame yet.
class Victims {
  public:
    Victims() {
        for (NodeIndex node = 0; node < grid.node_count(); ++node) {
            TileEntry& entry = table.queue(node, {node, 1});
            table.become_ready(entry);
            table.become_resident(entry, GpuSlot{node}, Seconds(0), Seconds(0));
        }
    }

    NodeIndex index(int level, int x, int y) const {
        return static_cast<NodeIndex>(grid.linear({level, x, y}));
    }
    // Everything that may leave for something of this priority, in order, each leaving as it is found.
    std::vector<NodeIndex> all(AgeWalk cache, const Wants& wants, std::uint32_t priority) {
        VictimSearch search(cache);
        search.restart(table, wants);
        std::vector<NodeIndex> nodes;
        while (TileEntry* entry = search.next(table, wants, priority)) {
            nodes.push_back(entry->node);
            if (entry->state == TileState::resident) table.leave_gpu(*entry);
            if (cache == AgeWalk::ram) table.remove(*entry);
        }
        return nodes;
    }
    Wants want(const std::vector<NodeIndex>& nodes, std::uint32_t frame) {
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            table.find(nodes[i])->wanted_stamp = 9;
            table.find(nodes[i])->priority = static_cast<std::uint32_t>(i);
        }
        return {nodes, 9, frame};
    }

    io::Grid grid{129, 129, 32};  // 1, 4 and 16 nodes
    Residency table{grid, 30};
};

}  // namespace

TEST_CASE_FIXTURE(Victims,
                  "everything unused and unwanted may leave but level 0, descendants before ancestors") {
    for (const AgeWalk cache : {AgeWalk::gpu_chunks, AgeWalk::ram}) {
        Victims fresh;
        const auto left = fresh.all(cache, {{}, 9, 100}, 0);
        REQUIRE(left.size() == 20);
        for (std::size_t i = 0; i < left.size(); ++i) {
            const io::NodeId id = grid.node_at(left[i]);
            CHECK(id.level > 0);
            for (std::size_t j = i + 1; j < left.size(); ++j)
                CHECK_FALSE(grid.node_at(left[j]).parent() == id);
        }
    }
}

TEST_CASE_FIXTURE(Victims, "what the current and the last frame used stays, and so do its ancestors") {
    table.use(index(2, 0, 0), 50);
    table.use(index(2, 3, 3), 49);
    table.use(index(2, 3, 0), 48);
    const auto left = all(AgeWalk::ram, {{}, 9, 50}, 0);
    CHECK(left.size() == 16);
    for (const NodeIndex kept : {index(2, 0, 0), index(1, 0, 0), index(2, 3, 3), index(1, 1, 1)})
        CHECK(table.state(kept) == TileState::resident);
}

TEST_CASE_FIXTURE(Victims, "the longest unused leaves first") {
    table.use(index(2, 1, 1), 11);
    table.use(index(2, 2, 2), 12);
    const auto left = all(AgeWalk::gpu_chunks, {{}, 9, 100}, 0);
    REQUIRE(left.size() == 20);
    const auto place = [&](NodeIndex node) {
        return std::find(left.begin(), left.end(), node) - left.begin();
    };
    CHECK(place(index(2, 0, 0)) < place(index(2, 1, 1)));
    CHECK(place(index(2, 1, 1)) < place(index(2, 2, 2)));
}

TEST_CASE_FIXTURE(Victims, "what is wanted leaves only for what is wanted more, least wanted first") {
    std::vector<NodeIndex> nodes;
    for (NodeIndex node = 0; node < grid.node_count(); ++node) nodes.push_back(node);
    CHECK(all(AgeWalk::ram, want(nodes, 100), 20).empty());
    CHECK(all(AgeWalk::ram, want(nodes, 100), 17) == std::vector<NodeIndex>{20, 19, 18});
}

}  // namespace ridgeline::pager
