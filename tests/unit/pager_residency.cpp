#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <vector>

#include "ridgeline/pager/residency.h"

namespace ridgeline::pager {
namespace {

constexpr Seconds kFade{0.5};

// The table as maps and lists, searched from end to end.
class NaiveResidency {
  public:
    explicit NaiveResidency(const io::Grid& grid) : grid_(grid) {}

    std::map<NodeIndex, TileState> states;
    std::vector<NodeIndex> by_age;  // of those that hold RAM, oldest first

    void renew(NodeIndex node) {
        std::erase(by_age, node);
        by_age.push_back(node);
    }
    void use(NodeIndex node) {
        for (io::NodeId id = grid_.node_at(node);; id = id.parent()) {
            const auto index = static_cast<NodeIndex>(grid_.linear(id));
            if (std::find(by_age.begin(), by_age.end(), index) != by_age.end()) renew(index);
            if (id.level == 0) return;
        }
    }
    std::uint32_t below(NodeIndex node, const auto& counts) const {
        std::uint32_t count = 0;
        const io::NodeId top = grid_.node_at(node);
        for (const auto& [other, state] : states) {
            io::NodeId id = grid_.node_at(other);
            if (id.level <= top.level) continue;
            while (id.level > top.level) id = id.parent();
            if (id == top && counts(state)) ++count;
        }
        return count;
    }

  private:
    io::Grid grid_;
};

bool holds_ram(TileState state) {
    return state == TileState::queued || state == TileState::ready || state == TileState::resident;
}

class Trial {
  public:
    explicit Trial(unsigned seed) : random_(seed), table_(grid_, 60), naive_(grid_) {}

    void run(int steps) {
        for (int i = 0; i < steps; ++i) {
            step();
            if (i % 16 == 0) compare();
        }
    }

  private:
    void step() {
        const auto node = static_cast<NodeIndex>(random_() % static_cast<std::uint64_t>(grid_.node_count()));
        TileEntry* entry = table_.find(node);
        const TileState state = table_.state(node);
        REQUIRE(state == (naive_.states.count(node) ? naive_.states[node] : TileState::absent));
        if (state == TileState::absent && !table_.full()) {
            queue(node);
        } else if (state == TileState::queued) {
            finish(*entry);
        } else if (state == TileState::ready) {
            if (random_() % 2 == 0) {
                table_.become_resident(*entry, GpuSlot{node}, Seconds(0), kFade);
                naive_.states[node] = TileState::resident;
            } else {
                remove(*entry);
            }
        } else if (state == TileState::resident && random_() % 2 == 0) {
            CHECK(table_.leave_gpu(*entry) == GpuSlot{node});
            naive_.states[node] = TileState::ready;
        } else if (state == TileState::failed) {
            if (random_() % 2 == 0)
                queue(node);
            else
                remove(*entry);
        }
        const auto used = static_cast<NodeIndex>(random_() % static_cast<std::uint64_t>(grid_.node_count()));
        table_.use(used, ++frame_);
        naive_.use(used);
    }

    void queue(NodeIndex node) {
        table_.queue(node, {node, 1});
        naive_.states[node] = TileState::queued;
        naive_.by_age.push_back(node);
    }
    void finish(TileEntry& entry) {
        const NodeIndex node = entry.node;
        switch (random_() % 8) {
            case 0:
                CHECK(table_.fail(entry, Seconds(1)).first_page == node);
                break;
            case 1:
                CHECK(table_.condemn(entry).first_page == node);
                break;
            case 2:
                return remove(entry);
            default:
                table_.become_ready(entry);
                break;
        }
        naive_.states[node] = table_.state(node);
        if (!holds_ram(naive_.states[node])) std::erase(naive_.by_age, node);
    }
    void remove(TileEntry& entry) {
        const NodeIndex node = entry.node;
        table_.remove(entry);
        naive_.states.erase(node);
        std::erase(naive_.by_age, node);
    }

    void compare() {
        for (NodeIndex node = 0; node < grid_.node_count(); ++node) {
            REQUIRE(table_.descendants_in_ram(node) == naive_.below(node, holds_ram));
            REQUIRE(table_.descendants_on_gpu(node) ==
                    naive_.below(node, [](TileState state) { return state == TileState::resident; }));
            REQUIRE(table_.snapshot()[node].resident == (table_.state(node) == TileState::resident));
        }
        REQUIRE(table_.in_ram_count() == naive_.by_age.size());
        std::vector<NodeIndex> by_age;
        table_.restart(AgeWalk::ram);
        while (const TileEntry* entry = table_.step(AgeWalk::ram)) by_age.push_back(entry->node);
        REQUIRE(by_age == naive_.by_age);
    }

    std::mt19937 random_;
    io::Grid grid_{513, 400, 64};
    Residency table_;
    NaiveResidency naive_;
    std::uint32_t frame_ = 0;
};

}  // namespace

TEST_CASE("counts of descendants and ages equal those of a naive table after any sequence of changes") {
    for (unsigned seed = 1; seed <= 10; ++seed) Trial(seed).run(1500);
}

TEST_CASE("a fade falls from one to nothing over its time, starts again on demand and ends with its chunk") {
    Residency table(io::Grid(200, 200, 32), 10);
    const auto fade = [&] { return table.snapshot()[3].fade; };
    TileEntry& entry = table.queue(3, {0, 1});
    table.become_ready(entry);
    table.become_resident(entry, GpuSlot{1}, Seconds(10), kFade);
    CHECK(fade() == 1.0f);
    table.advance_fades(Seconds(10.25));
    CHECK(fade() == doctest::Approx(0.5));
    table.restart_fade(entry, Seconds(10.25), kFade);
    CHECK(fade() == 1.0f);
    table.advance_fades(Seconds(10.75));
    CHECK(fade() == 0.0f);
    CHECK_FALSE(table.fading());
    table.restart_fade(entry, Seconds(11), kFade);
    table.leave_gpu(entry);
    CHECK(fade() == 0.0f);
    CHECK_FALSE(table.fading());
    table.become_resident(entry, GpuSlot{1}, Seconds(12), Seconds(0));
    CHECK(fade() == 0.0f);
}

TEST_CASE("a walk by age goes on past entries that are removed or renewed under it") {
    Residency table(io::Grid(600, 600, 32), 100);
    for (NodeIndex node = 1; node <= 6; ++node) table.queue(node, {node, 1});
    table.restart(AgeWalk::ram);
    CHECK(table.step(AgeWalk::ram)->node == 1);
    table.remove(*table.find(2));
    table.renew(*table.find(3));
    CHECK(table.step(AgeWalk::ram)->node == 4);
    table.remove(*table.find(4));
    CHECK(table.step(AgeWalk::ram)->node == 5);
    CHECK(table.step(AgeWalk::ram)->node == 6);
    CHECK(table.step(AgeWalk::ram)->node == 3);
    CHECK(table.step(AgeWalk::ram) == nullptr);
}

TEST_CASE("of very many failed nodes the longest failed are forgotten, and each is reported once") {
    const io::Grid grid(8193, 8193, 32);
    Residency table(grid, 5000);
    for (NodeIndex node = 100; node < 10100; ++node) {
        table.fail(table.queue(node, {0, 1}), Seconds(1));
        REQUIRE(table.report_once(node));
        REQUIRE_FALSE(table.report_once(node));
    }
    CHECK(table.state(100) == TileState::absent);
    CHECK(table.state(10099) == TileState::failed);
    CHECK_FALSE(table.full());
    CHECK_FALSE(table.report_once(100));
}

TEST_CASE("a damaged node stays damaged and holds nothing") {
    Residency table(io::Grid(200, 200, 32), 4);
    CHECK(table.condemn(table.queue(2, {7, 1})).first_page == 7);
    CHECK(table.state(2) == TileState::damaged);
    CHECK(table.find(2) == nullptr);
    CHECK(table.in_ram_count() == 0);
}

}  // namespace ridgeline::pager
