#include <doctest/doctest.h>

#include <atomic>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

#include "ridgeline/jobs/job_system.h"
#include "ridgeline/pager/read_group.h"
#include "unit/pager_fixture.h"

namespace ridgeline::pager {
namespace {

using test::FakeRenderer;
using test::FakeStore;
using test::PatternDecoder;

// Lets the reads of a source pass until it is closed; from then on it counts them, and holds them until it is
// opened.
class Gate {
  public:
    explicit Gate(test::MemorySource& source) {
        source.before_read = [this](std::uint64_t offset, std::size_t) {
            if (!counting_.load()) return;
            {
                const std::lock_guard lock(mutex_);
                offsets_.push_back(offset);
            }
            reads_.fetch_add(1);
            reads_.notify_all();
            open_.wait(false);
        };
    }
    void close() {
        open_.store(false);
        counting_.store(true);
    }
    void open() {
        open_.store(true);
        open_.notify_all();
    }
    void wait_for_reads(int count) {
        for (int now = reads_.load(); now < count; now = reads_.load()) reads_.wait(now);
    }
    std::vector<std::uint64_t> offsets() {
        const std::lock_guard lock(mutex_);
        return offsets_;
    }

  private:
    std::atomic<bool> open_{true}, counting_{false};
    std::atomic<int> reads_{0};
    std::mutex mutex_;
    std::vector<std::uint64_t> offsets_;
};

struct Rig {
    explicit Rig(PagerOptions options = {}, int workers = 1)
        : jobs({.workers = workers}), pager(Pager::create(store.source(), jobs, options, &decoder).value()) {}
    // The pager's thread may stand before the gate, and reads on until it is joined.
    ~Rig() { gate.open(); }

    FakeStore store;
    Gate gate{store.mesh};
    PatternDecoder decoder;
    jobs::JobSystem jobs;
    Pager pager;
};

// Of `level`, in linear order.
std::vector<NodeIndex> nodes_of(const io::Grid& grid, int level) {
    std::vector<NodeIndex> nodes;
    for (auto i = grid.first(level); i < grid.first(level + 1); ++i)
        nodes.push_back(static_cast<NodeIndex>(i));
    return nodes;
}

}  // namespace

TEST_CASE("level 0 is in RAM before the first frame and stays whatever is wanted") {
    Rig rig;
    REQUIRE(rig.pager.load_level0());
    for (const NodeIndex root : nodes_of(rig.store.grid(), 0)) {
        CHECK(rig.pager.state(root) == TileState::ready);
        CHECK(test::intact(rig.pager.chunk(root), rig.store.id(root)));
    }
    FakeRenderer renderer(rig.pager, rig.store, {});
    CHECK(renderer.settle({}));
    for (const NodeIndex root : nodes_of(rig.store.grid(), 0)) CHECK(renderer.resident(root));
}

TEST_CASE("where level 0 does not fit, the error names the least size that does") {
    FakeStore store({.width = 20000, .height = 600, .quads = 128, .max_vertices = 3000});
    PatternDecoder decoder;
    jobs::JobSystem jobs({.workers = 1});
    auto small = Pager::create(store.source(), jobs, {.ram_bytes = 1 << 20}, &decoder).value();
    const auto loaded = small.load_level0();
    REQUIRE_FALSE(loaded);
    const std::string message = loaded.error().message;
    CAPTURE(message);
    REQUIRE(message.starts_with("fake.terrain: level 0 needs "));
    const auto least = std::stoull(message.substr(message.find("needs ") + 6));
    CHECK(message.ends_with("use --ram-cache " + std::to_string(least) + "MiB or more"));
    auto enough = Pager::create(store.source(), jobs, {.ram_bytes = least << 20}, &decoder).value();
    CHECK(enough.load_level0());
    auto less = Pager::create(store.source(), jobs, {.ram_bytes = (least - 1) << 20}, &decoder).value();
    CHECK_FALSE(less.load_level0());
    // Also where not a single page fits.
    const auto none = Pager::create(store.source(), jobs, {.ram_bytes = 100}, &decoder);
    REQUIRE_FALSE(none);
    CHECK(none.error().message == message);
}

TEST_CASE("a damaged level 0 is an error that names the store") {
    Rig rig;
    rig.store.damage(0);
    const auto loaded = rig.pager.load_level0();
    REQUIRE_FALSE(loaded);
    CHECK(loaded.error().message == "fake.terrain: root tile 0/0/0: the checksum does not match");
}

TEST_CASE("all that is wanted arrives whole, with any number of workers") {
    for (const int workers : {1, 2, 3}) {
        Rig rig({}, workers);
        REQUIRE(rig.pager.load_level0());
        FakeRenderer renderer(rig.pager, rig.store, {});
        const auto wanted = test::nodes_around(rig.store.grid(), 500, 300, 3);
        REQUIRE(renderer.settle(wanted));
        for (const NodeIndex node : wanted) {
            REQUIRE(renderer.resident(node));
            REQUIRE(test::intact(rig.pager.chunk(node), rig.store.id(node)));
        }
        const PagerCounters counts = rig.pager.counters();
        CHECK(counts.loaded + nodes_of(rig.store.grid(), 0).size() == wanted.size());
        CHECK(counts.requested == counts.loaded);
        CHECK(counts.failed + counts.cancelled + counts.evicted == 0);
        // Neighbours were read together.
        CHECK(counts.reads < counts.loaded);
    }
}

TEST_CASE("requests that fell out of the wanted set are cancelled while queued and while being read") {
    Rig rig;
    REQUIRE(rig.pager.load_level0());
    FakeRenderer renderer(rig.pager, rig.store, {});
    Gate& gate = rig.gate;
    gate.close();
    const auto wanted = nodes_of(rig.store.grid(), rig.store.grid().finest());
    renderer.frame(wanted);
    const std::uint64_t requested = rig.pager.counters().requested;
    CHECK(requested > 200);
    gate.wait_for_reads(1);
    CHECK(rig.pager.state(wanted[0]) == TileState::reading);
    renderer.frame({});
    CHECK(rig.pager.counters().cancelled == requested);
    for (const NodeIndex node : wanted) REQUIRE(rig.pager.state(node) == TileState::absent);
    // Their slots and blocks serve others at once, while the I/O thread still holds the stale ones.
    const auto others = test::nodes_around(rig.store.grid(), 900, 100, 2);
    renderer.frame(others);
    gate.open();
    REQUIRE(renderer.settle(others));
    for (const NodeIndex node : others) REQUIRE(renderer.resident(node));
}

TEST_CASE("the newest batch wins: what is urgent is read next, whatever was queued before") {
    Rig rig;
    REQUIRE(rig.pager.load_level0());
    FakeRenderer renderer(rig.pager, rig.store, {});
    Gate& gate = rig.gate;
    gate.close();
    auto wanted = nodes_of(rig.store.grid(), rig.store.grid().finest());
    renderer.frame(wanted);
    gate.wait_for_reads(1);
    const NodeIndex urgent = wanted.back();
    REQUIRE(rig.pager.state(urgent) != TileState::reading);
    wanted.insert(wanted.begin(), urgent);
    renderer.frame(wanted);
    gate.open();
    gate.wait_for_reads(2);
    const std::uint64_t second = gate.offsets()[1];
    const io::PayloadRef& payload = rig.store.records[urgent].mesh;
    CHECK(second <= payload.offset);
    CHECK(payload.offset < second + ReadLimits{}.max_read_bytes);
}

TEST_CASE("urgent requests take the slots of less urgent ones") {
    Rig rig({.max_requests = 8});
    REQUIRE(rig.pager.load_level0());
    FakeRenderer renderer(rig.pager, rig.store, {});
    Gate& gate = rig.gate;
    gate.close();
    const auto finest = nodes_of(rig.store.grid(), rig.store.grid().finest());
    renderer.frame(std::span(finest).first(20));
    CHECK(rig.pager.counters().requested == 8);
    // What is read cannot be taken from; what is queued can.
    renderer.frame(std::span(finest).last(1));
    CHECK(rig.pager.state(finest.back()) != TileState::absent);
    std::vector<NodeIndex> wanted(finest.end() - 8, finest.end());
    renderer.frame(wanted);
    wanted.insert(wanted.begin(), finest.begin(), finest.begin() + 4);
    renderer.frame(wanted);
    gate.open();
    REQUIRE(renderer.settle(wanted));
    for (const NodeIndex node : wanted) CHECK(rig.pager.state(node) == TileState::ready);
}

TEST_CASE("a late chunk fades in where its parent was drawn, and at once where nothing was") {
    Rig rig;
    REQUIRE(rig.pager.load_level0());
    const io::Grid& grid = rig.store.grid();
    const auto level1 = nodes_of(grid, 1);
    FakeRenderer renderer(rig.pager, rig.store, {});
    renderer.frame({});
    while (!renderer.resident(level1[0])) renderer.frame(std::span(level1).first(1));
    const auto fade = [&](NodeIndex node) { return rig.pager.lend_to_selection().snapshot()[node].fade; };
    CHECK(fade(0) == 0.0f);
    CHECK(fade(level1[0]) == 1.0f);
    CHECK(rig.pager.fading());
    // Half a second, in frames of a sixtieth.
    for (int i = 0; i < 31; ++i) renderer.frame(std::span(level1).first(1));
    CHECK(fade(level1[0]) == 0.0f);
    CHECK_FALSE(rig.pager.fading());
    rig.pager.hold_back(std::span(level1).first(1));
    CHECK(fade(level1[0]) == 1.0f);
}

TEST_CASE(
    "a chunk that can never fit beside level 0 neither blocks others nor keeps the walk from settling") {
    FakeStore store;
    const auto level1 = nodes_of(store.grid(), 1);
    store.records[level1[0]].vertex_count = 60000;
    PatternDecoder decoder;
    jobs::JobSystem jobs({.workers = 1});
    auto pager = Pager::create(store.source(), jobs, {.ram_bytes = 512 << 10}, &decoder).value();
    REQUIRE(pager.load_level0());
    FakeRenderer renderer(pager, store, {});
    REQUIRE(renderer.settle(level1));
    CHECK(pager.state(level1[0]) == TileState::absent);
    CHECK(pager.state(level1[1]) == TileState::resident);
}

TEST_CASE("a chunk whose bytes are whole but do not decode is damaged for good") {
    Rig rig;
    rig.decoder.refused = {1, 0, 0};
    REQUIRE(rig.pager.load_level0());
    FakeRenderer renderer(rig.pager, rig.store, {.step = Seconds(1)});
    const auto level1 = nodes_of(rig.store.grid(), 1);
    REQUIRE(renderer.settle(level1));
    CHECK(rig.pager.state(level1[0]) == TileState::damaged);
    const PagerCounters counts = rig.pager.counters();
    CHECK(counts.failed == 1);
    for (int i = 0; i < 10; ++i) renderer.frame(level1);
    CHECK(rig.pager.counters().requested == counts.requested);
}

TEST_CASE("a chunk whose checksum does not match is tried again every two seconds while it is wanted") {
    Rig rig;
    const auto level1 = nodes_of(rig.store.grid(), 1);
    rig.store.damage(level1[0]);
    REQUIRE(rig.pager.load_level0());
    FakeRenderer renderer(rig.pager, rig.store, {.step = Seconds(0)});
    REQUIRE(renderer.settle(level1));
    CHECK(rig.pager.state(level1[0]) == TileState::failed);
    CHECK(rig.pager.counters().failed == 1);
    CHECK(rig.pager.counters().retried == 2);
    // The clock stands: nothing is tried.
    for (int i = 0; i < 10; ++i) renderer.frame(level1);
    CHECK(rig.pager.state(level1[0]) == TileState::failed);
    rig.pager.begin_frame(1000, Seconds(1.9));
    rig.pager.request(level1);
    CHECK(rig.pager.state(level1[0]) == TileState::failed);
    // The disk has recovered.
    rig.store.damage(level1[0]);
    rig.pager.begin_frame(1001, Seconds(2.0));
    rig.pager.request(level1);
    REQUIRE(renderer.settle(level1));
    CHECK(renderer.resident(level1[0]));
    CHECK(rig.pager.counters().retried == 3);
}

TEST_CASE("imagery comes by the same list: in its order, counted apart, told from chunks by its place") {
    FakeStore store({.imagery_width = 3000, .imagery_height = 2000});
    PatternDecoder decoder;
    jobs::JobSystem jobs({.workers = 2});
    auto pager = Pager::create(store.source(), jobs, {}, &decoder).value();
    REQUIRE(pager.load_level0());
    FakeRenderer renderer(pager, store, {});
    const NodeIndex imagery = store.tiles().begin(TileKind::imagery);
    std::vector<NodeIndex> wanted = test::nodes_around(store.grid(), 500, 300, 1);
    const std::size_t chunks = wanted.size();
    for (const NodeIndex node : test::nodes_around(store.imagery_grid(), 1500, 1000, 1))
        wanted.push_back(imagery + node);
    REQUIRE(renderer.settle(wanted));
    for (const NodeIndex node : wanted) REQUIRE(renderer.resident(node));
    CHECK(pager.counters(TileKind::chunk).loaded == chunks - store.tiles().root_count(TileKind::chunk));
    CHECK(pager.counters(TileKind::imagery).loaded ==
          wanted.size() - chunks - store.tiles().root_count(TileKind::imagery));
    CHECK(pager.counters(TileKind::imagery).reads > 0);
    CHECK(pager.counters(TileKind::imagery).bytes_read > 0);
    CHECK(pager.counters().loaded ==
          pager.counters(TileKind::chunk).loaded + pager.counters(TileKind::imagery).loaded);
    CHECK_FALSE(pager.chunk(wanted.back()));
    // What falls out of the list is cancelled, of whichever kind.
    renderer.frame(std::span(wanted).first(chunks));
    CHECK(pager.state(wanted.back()) == TileState::resident);
}

}  // namespace ridgeline::pager
