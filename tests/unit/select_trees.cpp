// The trees of a frame against slow exact references: what is ideal, what is drawn, what is wanted.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <map>
#include <set>

#include "unit/select_scene.h"

namespace ridgeline::test {
namespace {

using io::NodeId;
using io::Side;
using select::NodeIndex;
using NodeSet = std::set<NodeId>;

const SceneShape kShapes[] = {{600, 530, 32, 1},  {129, 129, 32, 2},      {257, 513, 32, 3, 0.2},
                              {1100, 270, 32, 4}, {450, 390, 32, 7, 0.3}, {66, 34, 32, 5}};

// Made once; making one takes longer than a thousand selections in it.
const std::deque<Scene>& scenes() {
    static const std::deque<Scene> made(std::begin(kShapes), std::end(kShapes));
    return made;
}

// Runs `check` on random frames of every scene.
using Check = std::function<void(const Scene&, Random&, select::Selection&, const select::Criterion&)>;
void for_random_frames(int frames, std::uint64_t seed, const Check& check) {
    for (const Scene& scene : scenes()) {
        Random random(seed++);
        for (const char* name : {"screen_error", "distance", "roughness", "density"}) {
            const auto criterion = select::make_criterion(name).value();
            select::Selection selection(scene.info(), scene.records(), *criterion);
            for (int i = 0; i < frames; ++i) check(scene, random, selection, *criterion);
        }
    }
}

Box box_of(const Scene& scene, const select::View& view, NodeId node) {
    const auto& record = scene.records()[static_cast<std::size_t>(scene.grid().linear(node))];
    const io::LatticePoint origin = scene.grid().origin(node);
    const auto extent = static_cast<double>(scene.grid().extent(node.level));
    const auto x = static_cast<double>(origin.x), y = static_cast<double>(origin.y);
    const auto& info = scene.info();
    const auto height = [&](std::int32_t quanta) {
        return info.height_offset_m + quanta * info.quantum_m * view.exaggeration;
    };
    return {{info.world(x, y + extent), height(record.min_quanta)},
            {info.world(x + extent, y), height(record.max_quanta)}};
}

bool splits(const Scene& scene, const select::View& view, const select::SwitchingRule& rule, NodeId node) {
    const auto& record = scene.records()[static_cast<std::size_t>(scene.grid().linear(node))];
    return node.level < scene.grid().finest() && record.has_data() &&
           distance(view.eye_m, box_of(scene, view, node)) < rule.distance_m(record.error_m, node.level);
}

// Split nodes of the ideal tree, by repeating its two rules until nothing changes.
NodeSet split_fixpoint(const Scene& scene, const select::View& view, const select::Criterion& criterion) {
    const io::Grid& grid = scene.grid();
    const auto rule = criterion.rule(view, scene.info(), grid);
    NodeSet split;
    const auto exists = [&](NodeId node) { return node.level == 0 || split.contains(node.parent()); };
    const auto wants_split = [&](NodeId node) {
        if (splits(scene, view, rule, node)) return true;
        for (int q = 0; q < io::kQuarters; ++q)
            for (int s = 0; s < io::kSides; ++s) {
                // A split neighbour of a child that lies in another node.
                const NodeId beyond = io::neighbour(node.child(q), static_cast<Side>(s));
                if (grid.contains(node.child(q)) && beyond.parent() != node && split.contains(beyond))
                    return true;
            }
        return false;
    };
    for (bool changed = true; changed;) {
        changed = false;
        for (std::int64_t i = 0; i < grid.first(grid.finest()); ++i) {
            const NodeId node = grid.node_at(i);
            if (!split.contains(node) && exists(node) && wants_split(node))
                changed = split.insert(node).second;
        }
    }
    return split;
}

// How often each quarter of a finest node is drawn, and by which level.
struct Cover {
    int times = 0;
    int level = -1;
};
using Covers = std::map<std::pair<std::int64_t, std::int64_t>, Cover>;
Covers covers_of(const Scene& scene, std::span<const select::DrawEntry> draws) {
    Covers covers;
    const std::int64_t cell = scene.grid().extent(scene.grid().finest()) / 2;
    for (const Unit& unit : units_of(scene, draws))
        for (std::int64_t y = unit.y; y < unit.y + unit.side; y += cell)
            for (std::int64_t x = unit.x; x < unit.x + unit.side; x += cell) {
                Cover& cover = covers[{x, y}];
                ++cover.times;
                cover.level = unit.entry->node.level;
            }
    return covers;
}

// Calls visit(x, y, node) for every quarter of a finest node that touches the raster.
template <class Visit>
void for_each_cell(const Scene& scene, Visit&& visit) {
    const io::Grid& grid = scene.grid();
    const std::int64_t cell = grid.extent(grid.finest()) / 2;
    for (std::int64_t y = 0; y < grid.height() - 1; y += cell)
        for (std::int64_t x = 0; x < grid.width() - 1; x += cell)
            visit(x, y,
                  NodeId{grid.finest(), static_cast<std::int32_t>(x / (2 * cell)),
                         static_cast<std::int32_t>(y / (2 * cell))});
}

// Whether the node and all its ancestors have data.
bool has_data(const Scene& scene, NodeId node) {
    return scene.records()[static_cast<std::size_t>(scene.grid().linear(node))].has_data();
}

// Whether a lattice point at a height, in quanta, lies in the picture.
bool in_picture(const Scene& scene, const select::View& view, std::int64_t x, std::int64_t y, double quanta) {
    const auto& info = scene.info();
    const glm::dvec3 point(info.world(static_cast<double>(x), static_cast<double>(y)),
                           info.height_offset_m + quanta * info.quantum_m * view.exaggeration);
    return std::all_of(view.visible.planes.begin(), view.visible.planes.end(), [&](const auto& plane) {
        return glm::dot(plane.normal, point) + plane.offset >= 0.0;
    });
}

}  // namespace

TEST_CASE("seen from everywhere, the drawn quarters cover the terrain exactly once, whatever is resident") {
    for_random_frames(
        12, 1, [](const Scene& scene, Random& random, select::Selection& selection, const auto&) {
            const auto residency = random_residency(scene, random);
            const auto covers = covers_of(scene, selection.run(view_of_all(scene, random), residency).draws);
            int wrong = 0;
            for_each_cell(scene, [&](std::int64_t x, std::int64_t y, NodeId) {
                const auto found = covers.find({x, y});
                wrong += found == covers.end() || found->second.times != 1;
            });
            // A child without data is no gap: nothing is there to draw.
            if (std::all_of(scene.records().begin(), scene.records().end(),
                            [](const auto& r) { return r.has_data(); }))
                CHECK(wrong == 0);
            CHECK(std::all_of(covers.begin(), covers.end(),
                              [](const auto& cover) { return cover.second.times == 1; }));
        });
}

TEST_CASE(
    "what is not drawn has no data or lies outside the picture, at its level's surface and its parent's") {
    for_random_frames(
        12, 2, [](const Scene& scene, Random& random, select::Selection& selection, const auto&) {
            const auto view = random_view(scene, random);
            const auto residency = all_resident(scene);
            const auto covers = covers_of(scene, selection.run(view, residency).draws);
            const std::int64_t cell = scene.grid().extent(scene.grid().finest()) / 2;
            int in_sight = 0;
            for_each_cell(scene, [&](std::int64_t x, std::int64_t y, NodeId node) {
                const auto found = covers.find({x, y});
                select::DrawEntry entry;
                const bool there = selection.entry_at(static_cast<double>(x) + 0.5,
                                                      static_cast<double>(y) + 0.5, residency, entry);
                if (found != covers.end() || !there || !has_data(scene, node)) return;
                for (const int level : {entry.node.level, std::max(entry.node.level - 1, 0)})
                    for (std::int64_t dy = 0; dy <= cell; ++dy)
                        for (std::int64_t dx = 0; dx <= cell; ++dx)
                            in_sight +=
                                in_picture(scene, view, x + dx, y + dy, scene.surface(x + dx, y + dy, level));
            });
            CHECK(in_sight == 0);
        });
}

TEST_CASE("drawn quarters that share an edge differ by at most one level") {
    for_random_frames(
        25, 3, [](const Scene& scene, Random& random, select::Selection& selection, const auto&) {
            const auto view =
                whole(random, 0, 1) == 0 ? view_of_all(scene, random) : random_view(scene, random);
            const auto residency = random_residency(scene, random);
            const auto covers = covers_of(scene, selection.run(view, residency).draws);
            const std::int64_t cell = scene.grid().extent(scene.grid().finest()) / 2;
            int apart = 0;
            for (const auto& [place, cover] : covers)
                for (const auto& next : {std::pair(place.first + cell, place.second),
                                         std::pair(place.first, place.second + cell)})
                    if (const auto found = covers.find(next); found != covers.end())
                        apart = std::max(apart, std::abs(found->second.level - cover.level));
            CHECK(apart <= 1);
        });
}

TEST_CASE("the ideal tree is the fixpoint of the criterion and of balance") {
    for_random_frames(
        6, 4, [](const Scene& scene, Random& random, select::Selection& selection, const auto& criterion) {
            const auto view = view_of_all(scene, random);
            NodeSet expected;
            for (const NodeId node : split_fixpoint(scene, view, criterion))
                for (int q = 0; q < io::kQuarters; ++q)
                    if (scene.grid().contains(node.child(q)) && has_data(scene, node.child(q)))
                        expected.insert(node.child(q));
            for (std::int64_t i = 0; i < scene.grid().first(1); ++i) expected.insert(scene.grid().node_at(i));
            NodeSet found;
            for (const auto& tile : selection.run(view, random_residency(scene, random)).wanted)
                found.insert(scene.grid().node_at(tile.index));
            CHECK(found == expected);
        });
}

TEST_CASE("every ideal node in view is wanted as visible") {
    for_random_frames(
        6, 12, [](const Scene& scene, Random& random, select::Selection& selection, const auto& criterion) {
            const auto view = random_view(scene, random);
            NodeSet visible;
            for (const auto& tile : selection.run(view, random_residency(scene, random)).wanted)
                if (tile.visible) visible.insert(scene.grid().node_at(tile.index));
            int forgotten = 0;
            for (const NodeId node : split_fixpoint(scene, view, criterion))
                for (int q = 0; q < io::kQuarters; ++q) {
                    const NodeId child = node.child(q);
                    if (!scene.grid().contains(child) || !has_data(scene, child)) continue;
                    const bool in_view =
                        contains(view.visible, box_of(scene, view, child)) != Containment::outside;
                    forgotten += in_view && !visible.contains(child);
                }
            CHECK(forgotten == 0);
        });
}

TEST_CASE("with all data at hand the drawn levels are the ideal ones") {
    for_random_frames(
        6, 5, [](const Scene& scene, Random& random, select::Selection& selection, const auto& criterion) {
            const auto view = view_of_all(scene, random);
            const NodeSet split = split_fixpoint(scene, view, criterion);
            const auto covers = covers_of(scene, selection.run(view, all_resident(scene)).draws);
            int wrong = 0;
            for_each_cell(scene, [&](std::int64_t x, std::int64_t y, NodeId node) {
                const auto found = covers.find({x, y});
                while (node.level > 0 && !split.contains(node.parent())) node = node.parent();
                wrong +=
                    has_data(scene, node) && (found == covers.end() || found->second.level != node.level);
            });
            CHECK(wrong == 0);
        });
}

TEST_CASE("more data never makes a place coarser") {
    for_random_frames(
        12, 6, [](const Scene& scene, Random& random, select::Selection& selection, const auto&) {
            const auto view =
                whole(random, 0, 1) == 0 ? view_of_all(scene, random) : random_view(scene, random);
            const auto less = random_residency(scene, random);
            auto more = less;
            for (std::size_t i = 0; i < more.size(); ++i) {
                const NodeId node = scene.grid().node_at(static_cast<std::int64_t>(i));
                const bool above =
                    node.level == 0 ||
                    more[static_cast<std::size_t>(scene.grid().linear(node.parent()))].resident;
                more[i].resident =
                    more[i].resident || (above && scene.records()[i].has_data() && whole(random, 0, 1) == 0);
            }
            const auto before = covers_of(scene, selection.run(view, less).draws);
            const auto after = covers_of(scene, selection.run(view, more).draws);
            int coarser = 0;
            for (const auto& [place, cover] : before) {
                const auto found = after.find(place);
                coarser += found != after.end() && found->second.level < cover.level;
            }
            CHECK(coarser == 0);
        });
}

TEST_CASE("the wanted list is in order of urgency, ancestors first, and holds all that is drawn") {
    for_random_frames(
        12, 7, [](const Scene& scene, Random& random, select::Selection& selection, const auto&) {
            const auto residency = random_residency(scene, random);
            const auto& result = selection.run(random_view(scene, random), residency);
            std::map<NodeIndex, std::size_t> place;
            int orphans = 0, disorder = 0, wrong_flags = 0, missing = 0;
            for (std::size_t i = 0; i < result.wanted.size(); ++i) {
                const auto& tile = result.wanted[i];
                const NodeId node = scene.grid().node_at(tile.index);
                if (node.level > 0)
                    orphans += !place.contains(static_cast<NodeIndex>(scene.grid().linear(node.parent())));
                CHECK(place.emplace(tile.index, i).second);
                wrong_flags += tile.resident != residency[tile.index].resident;
                missing += tile.visible && !tile.resident;
                if (i == 0) continue;
                const auto& last = result.wanted[i - 1];
                const auto urgency = [&](const select::WantedTile& t) {
                    return std::tuple(!t.visible, scene.grid().node_at(t.index).level, -t.error_px);
                };
                disorder += urgency(last) > urgency(tile);
            }
            CHECK(orphans == 0);
            CHECK(disorder == 0);
            CHECK(wrong_flags == 0);
            CHECK(static_cast<std::uint32_t>(missing) == result.counters.missing);
            CHECK(std::all_of(result.draws.begin(), result.draws.end(), [&](const auto& entry) {
                return result.wanted[place.at(entry.index)].visible;
            }));
        });
}

TEST_CASE("a view that moves and turns wants more than what it sees") {
    const Scene& scene = scenes().front();
    const auto criterion = select::make_criterion("screen_error").value();
    select::Selection selection(scene.info(), scene.records(), *criterion);
    Random random(8);
    std::size_t resting = 0, moving = 0;
    for (int i = 0; i < 50; ++i) {
        auto view = random_view(scene, random);
        view.extension.margin_m = 0.0;
        resting += selection.run(view, all_resident(scene)).wanted.size();
        view.extension = select::ExtensionZone(view.extension.direction, Angle::from_degrees(120.0), 800.0);
        const auto& result = selection.run(view, all_resident(scene));
        moving += result.wanted.size();
        std::set<NodeIndex> wanted;
        for (const auto& tile : result.wanted) {
            const NodeId node = scene.grid().node_at(tile.index);
            CHECK(wanted.insert(tile.index).second);
            if (node.level > 0)
                CHECK(wanted.contains(static_cast<NodeIndex>(scene.grid().linear(node.parent()))));
        }
    }
    CHECK(moving > resting);
}

TEST_CASE("a wanted list cut to its capacity is the start of the whole one") {
    const Scene& scene = scenes().front();
    const auto criterion = select::make_criterion("distance").value();
    select::Selection whole_list(scene.info(), scene.records(), *criterion);
    select::Selection cut(scene.info(), scene.records(), *criterion, {.wanted_capacity = 12});
    Random random(9);
    for (int i = 0; i < 50; ++i) {
        const auto view = random_view(scene, random);
        const auto residency = random_residency(scene, random);
        const auto all = whole_list.run(view, residency).wanted;
        const auto some = cut.run(view, residency).wanted;
        REQUIRE(some.size() == std::min<std::size_t>(all.size(), 12));
        for (std::size_t k = 0; k < some.size(); ++k) CHECK(some[k].index == all[k].index);
    }
}

TEST_CASE(
    "used and held back nodes are resident, wanted and disjoint; used ones are closed under ancestors") {
    for_random_frames(
        12, 10, [](const Scene& scene, Random& random, select::Selection& selection, const auto&) {
            const auto residency = random_residency(scene, random);
            const auto& result = selection.run(random_view(scene, random), residency);
            std::set<NodeIndex> used(result.used.begin(), result.used.end());
            for (const NodeIndex index : result.used) {
                const NodeId node = scene.grid().node_at(index);
                CHECK(residency[index].resident);
                if (node.level > 0)
                    CHECK(used.contains(static_cast<NodeIndex>(scene.grid().linear(node.parent()))));
            }
            for (const NodeIndex index : result.held_back) {
                CHECK(residency[index].resident);
                CHECK(!used.contains(index));
            }
            CHECK(std::all_of(result.draws.begin(), result.draws.end(),
                              [&](const auto& entry) { return used.contains(entry.index); }));
        });
}

TEST_CASE("the node nearest to the eye is drawn first") {
    for_random_frames(12, 11,
                      [](const Scene& scene, Random& random, select::Selection& selection, const auto&) {
                          const auto view = view_of_all(scene, random);
                          const auto& result = selection.run(view, all_resident(scene));
                          if (result.draws.empty()) return;
                          const glm::dvec2 place = scene.info().lattice(view.eye_m.x, view.eye_m.y);
                          const auto units = units_of(scene, result.draws);
                          for (const Unit& unit : units) {
                              const auto x = static_cast<double>(unit.x), y = static_cast<double>(unit.y),
                                         side = static_cast<double>(unit.side);
                              if (place.x > x && place.x < x + side && place.y > y && place.y < y + side)
                                  CHECK(unit.entry == &result.draws.front());
                          }
                      });
}

}  // namespace ridgeline::test
