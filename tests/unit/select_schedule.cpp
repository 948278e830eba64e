#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <set>

#include "ridgeline/select/tile_schedule.h"
#include "unit/select_scene.h"

namespace ridgeline::test {
namespace {

using io::NodeId;
using select::GroundBounds;
using select::GroundMask;
using select::GroundRectangle;
using select::GroundView;
using select::TileSchedule;
using select::TileTree;

// Lattices of other proportions than the heights', whose last tiles reach over the terrain's border; some
// tiles missing with all below them.
TileTree random_tree(const io::TerrainInfo& info, Random& random) {
    const int texels = 32 << whole(random, 0, 2);
    const auto width = whole(random, 40, 1500), height = whole(random, 40, 1500);
    TileTree tree{.grid = io::Grid(width + 1, height + 1, texels),
                  .west_m = info.min_east_m(),
                  .north_m = info.max_north_m(),
                  .spacing_x_m = (info.max_east_m() - info.min_east_m()) / width,
                  .spacing_y_m = (info.max_north_m() - info.min_north_m()) / height,
                  .present = {}};
    if (whole(random, 0, 2) == 0) return tree;
    const double missing = uniform(random, 0.0, 0.3);
    tree.present.assign(static_cast<std::size_t>(tree.grid.node_count()), true);
    for (std::int64_t i = 0; i < tree.grid.node_count(); ++i) {
        const NodeId node = tree.grid.node_at(i);
        const bool hangs =
            node.level == 0 || tree.has(static_cast<std::size_t>(tree.grid.linear(node.parent())));
        tree.present[static_cast<std::size_t>(i)] = hangs && uniform(random, 0.0, 1.0) >= missing;
    }
    return tree;
}

GroundRectangle random_rectangle(const GroundRectangle& within, double largest, Random& random) {
    const glm::dvec2 size = within.max - within.min;
    const glm::dvec2 extent = size * glm::dvec2(uniform(random, 0.0, largest), uniform(random, 0.0, largest));
    const glm::dvec2 at(uniform(random, -0.1, 1.0), uniform(random, -0.1, 1.0));
    const glm::dvec2 corner = within.min + at * size;
    return {corner, corner + extent};
}

struct RandomView {
    RandomView(const Scene& scene, const GroundBounds& ground, Random& random) {
        const select::View eye = random_view(scene, random);
        const GroundRectangle terrain = ground.terrain();
        view.eye_m = eye.eye_m;
        view.projection_px = eye.projection_px;
        view.pixel_error_px = std::exp2(uniform(random, -2.0, 4.0));
        view.exaggeration = eye.exaggeration;
        view.rectangle = random_rectangle(terrain, 1.2, random);
        view.picture = eye.picture;
        if (whole(random, 0, 1) == 0) view.soon_m = std::exp2(uniform(random, 0.0, 12.0));
        const int masks = whole(random, 0, 2);
        for (int i = 0; i < masks; ++i) {
            seen[i].clear(select::GroundLattice(terrain), glm::dvec2(view.eye_m));
            for (int n = whole(random, 0, 6); n > 0; --n)
                seen[i].mark(random_rectangle(terrain, 0.3, random));
        }
        view.seen = std::span(seen).first(static_cast<std::size_t>(masks));
    }
    RandomView(const RandomView&) = delete;
    RandomView& operator=(const RandomView&) = delete;

    GroundMask seen[2];
    GroundView view;
};

// The four steps over plain sets, one after the other, regularised again after every merge.
class SlowSchedule {
  public:
    SlowSchedule(const TileSchedule& schedule, const GroundView& view) : schedule_(schedule), view_(view) {
        divide();
        regularise();
        while (chosen_.size() > schedule.capacity()) {
            merge_farthest();
            regularise();
        }
    }

    const std::set<NodeId>& chosen() const { return chosen_; }
    // Or may be soon.
    bool is_seen(NodeId node) const {
        return tree().grid.contains(node) && tree().has(static_cast<std::size_t>(tree().grid.linear(node))) &&
               (view_.sees(tree().area(node)) || is_soon(node));
    }
    bool passes(NodeId node) const { return place_.contains(node); }
    // Every seen part of it is sampled from tiles below it.
    bool is_covered_below(const std::set<NodeId>& chosen, NodeId node) const {
        if (node.level == tree().grid.finest()) return false;
        for (int q = 0; q < io::kQuarters; ++q) {
            const NodeId child = node.child(q);
            if (!is_seen(child) || chosen.contains(child)) continue;
            if (!passes(child) || !is_covered_below(chosen, child)) return false;
        }
        return true;
    }

  private:
    const TileTree& tree() const { return schedule_.tree(); }
    bool is_soon(NodeId node) const { return schedule_.may_see_soon(tree().area(node), node.level, view_); }
    // Never nearer than the ancestors.
    double distance_m(NodeId node) const {
        if (node.level == 0) return 0.0;
        const GroundRectangle whole = tree().area(node);
        const GroundRectangle area = is_soon(node) ? whole : whole.within(view_.rectangle);
        return std::max(schedule_.distance_m(area, node.level, view_), distance_m(node.parent()));
    }

    void divide() {
        std::vector<NodeId> level;
        for (std::int64_t i = 0; i < tree().grid.first(1); ++i)
            if (is_seen(tree().grid.node_at(i))) level.push_back(tree().grid.node_at(i));
        while (!level.empty()) {
            std::vector<NodeId> next;
            for (const NodeId node : level) {
                place_.emplace(node, place_.size());
                if (node.level > 0) chosen_.insert(node);
                for (int q = 0; q < io::kQuarters && node.level < tree().grid.finest(); ++q)
                    if (is_seen(node.child(q)) &&
                        distance_m(node.child(q)) < schedule_.reach_m(node.level, view_))
                        next.push_back(node.child(q));
            }
            level = next;
        }
    }
    void regularise() {
        const std::set<NodeId> before = chosen_;
        std::erase_if(chosen_, [&](NodeId node) { return is_covered_below(before, node); });
    }
    void merge_farthest() {
        const NodeId farthest = *std::max_element(chosen_.begin(), chosen_.end(), [&](NodeId a, NodeId b) {
            return std::pair(distance_m(a), place_.at(a)) < std::pair(distance_m(b), place_.at(b));
        });
        for (int q = 0; q < io::kQuarters; ++q) chosen_.erase(farthest.parent().child(q));
        if (farthest.level > 1) chosen_.insert(farthest.parent());
    }

    const TileSchedule& schedule_;
    const GroundView& view_;
    std::map<NodeId, std::size_t> place_;  // of those that pass, level by level
    std::set<NodeId> chosen_;
};

std::set<NodeId> nodes_of(const select::TileScheduleResult& result) {
    std::set<NodeId> nodes;
    for (const auto& tile : result.tiles) nodes.insert(tile.node);
    return nodes;
}

void check_order(const TileSchedule& schedule) {
    const auto tiles = schedule.result().tiles;
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        CHECK(tiles[i].index == schedule.tree().grid.linear(tiles[i].node));
        CHECK(tiles[i].node.level > 0);
        if (i == 0) continue;
        CHECK(std::pair(tiles[i - 1].node.level, tiles[i - 1].distance_m) <=
              std::pair(tiles[i].node.level, tiles[i].distance_m));
    }
}

}  // namespace

TEST_CASE("schedule: the same tiles as by the four steps over sets, for any tree, view and number of slots") {
    std::size_t merged = 0, empty = 0, most = 0;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        const Scene scene({.width = 150, .height = 100, .seed = seed, .nodata_share = seed % 2 ? 0.2 : 0.0});
        const GroundBounds ground(scene.info(), scene.records());
        Random random(seed);
        for (int i = 0; i < 40; ++i) {
            const auto capacity = static_cast<std::size_t>(whole(random, 0, 3) == 0 ? whole(random, 0, 5)
                                                                                    : whole(random, 6, 300));
            TileSchedule schedule(random_tree(scene.info(), random), ground, capacity);
            for (int j = 0; j < 4; ++j) {
                const RandomView random_view(scene, ground, random);
                const auto& result = schedule.run(random_view.view);
                const SlowSchedule slow(schedule, random_view.view);
                CHECK(result.tiles.size() <= capacity);
                CHECK(nodes_of(result) == slow.chosen());
                check_order(schedule);
                merged += result.counters.merges;
                empty += result.tiles.empty();
                most = std::max(most, result.tiles.size());
            }
        }
    }
    CHECK(merged > 1000);
    CHECK(empty > 10);
    CHECK(most > 150);
}

TEST_CASE("schedule: no tile whose seen part its chosen children cover, and none that is not seen") {
    const Scene scene({.width = 150, .height = 100, .seed = 9});
    const GroundBounds ground(scene.info(), scene.records());
    Random random(2);
    for (int i = 0; i < 100; ++i) {
        TileSchedule schedule(random_tree(scene.info(), random), ground, 100);
        const RandomView random_view(scene, ground, random);
        const auto chosen = nodes_of(schedule.run(random_view.view));
        const SlowSchedule slow(schedule, random_view.view);
        for (const NodeId node : chosen) {
            CHECK(slow.is_seen(node));
            CHECK_FALSE(slow.is_covered_below(chosen, node));
        }
    }
}

TEST_CASE("schedule: with room for all, every seen place samples the finest tile that the threshold chose") {
    const Scene scene({.width = 150, .height = 100, .seed = 5});
    const GroundBounds ground(scene.info(), scene.records());
    Random random(3);
    int places = 0;
    for (int i = 0; i < 60; ++i) {
        TileSchedule schedule(random_tree(scene.info(), random), ground, 100000);
        const RandomView random_view(scene, ground, random);
        const auto chosen = nodes_of(schedule.run(random_view.view));
        const SlowSchedule slow(schedule, random_view.view);
        const io::Grid& grid = schedule.tree().grid;
        for (int j = 0; j < 200; ++j) {
            NodeId node{grid.finest(), whole(random, 0, grid.nodes_x(grid.finest()) - 1),
                        whole(random, 0, grid.nodes_y(grid.finest()) - 1)};
            if (!slow.is_seen(node)) continue;
            while (node.level > 0 && !chosen.contains(node)) {
                CHECK_FALSE(slow.passes(node));
                node = node.parent();
            }
            ++places;
        }
    }
    CHECK(places > 500);
}

// The same tree twice: with its finest levels made, and with all of them paged.
TEST_CASE("schedule: made levels are chosen as if they were paged, and none where they are not asked for") {
    const Scene scene({.width = 150, .height = 100, .seed = 6});
    const GroundBounds ground(scene.info(), scene.records());
    const int source_finest = scene.grid().finest();
    Random random(8);
    std::size_t made_tiles = 0;
    for (int i = 0; i < 60; ++i) {
        const int octaves = whole(random, 1, 3);
        TileTree tree = select::heights_tree(scene.info(), scene.records(), octaves);
        REQUIRE(tree.grid.finest() == source_finest + octaves);
        TileSchedule made(tree, ground, 100000);
        tree.made_levels = 0;
        tree.present.resize(static_cast<std::size_t>(tree.grid.node_count()));
        for (std::int64_t n = scene.grid().node_count(); n < tree.grid.node_count(); ++n)
            tree.present[static_cast<std::size_t>(n)] =
                tree.present[static_cast<std::size_t>(tree.grid.linear(tree.grid.node_at(n).parent()))];
        TileSchedule paged(tree, ground, 100000);
        RandomView random_view(scene, ground, random);
        GroundView& view = random_view.view;
        made.choose_made(view.pixel_error_px);
        const auto chosen = nodes_of(made.run(view));
        CHECK(chosen == nodes_of(paged.run(view)));
        made_tiles += static_cast<std::size_t>(
            std::ranges::count_if(chosen, [&](NodeId node) { return node.level > source_finest; }));
        made.choose_made({});
        for (const auto& tile : made.run(view).tiles) CHECK(tile.node.level <= source_finest);
        // An eye so high over the ground has none of it near, whatever heights its tile has.
        made.choose_made(view.pixel_error_px);
        view.eye_above_ground_m = 1e9;
        for (const auto& tile : made.run(view).tiles) CHECK(tile.node.level <= source_finest);
    }
    CHECK(made_tiles > 300);
}

TEST_CASE(
    "schedule: what a moving eye may soon see is wanted although nothing is seen, and nothing farther") {
    const Scene scene({.width = 150, .height = 100, .seed = 11});
    const GroundBounds ground(scene.info(), scene.records());
    const TileTree tree = select::heights_tree(scene.info(), scene.records());
    const glm::dvec2 size_m = ground.terrain().max - ground.terrain().min;
    Random random(12);
    int near = 0, wanted = 0;
    for (int i = 0; i < 200; ++i) {
        TileSchedule schedule(tree, ground, 100000);
        const select::View eye = random_view(scene, random);
        GroundView view;
        view.eye_m = eye.eye_m;
        view.pixel_error_px = 1e-6;  // all as fine as can be
        view.exaggeration = eye.exaggeration;
        view.picture = eye.picture;
        view.soon_m = uniform(random, 0.0, 1.0) * glm::length(size_m);
        const auto chosen = nodes_of(schedule.run(view));
        // No tile without ground that may be seen soon; the boxes are at least those of the ground.
        for (const NodeId node : chosen) {
            const GroundRectangle area = tree.area(node);
            const glm::dvec2 at = glm::clamp(glm::dvec2(view.eye_m), area.min, area.max);
            CHECK(glm::distance(at, glm::dvec2(view.eye_m)) < view.soon_m);
            ++wanted;
        }
        for (int j = 0; j < 100; ++j) {
            const int x = whole(random, 0, 149), y = whole(random, 0, 99);
            const glm::dvec3 place(scene.info().world(x, y),
                                   ground.height_m(scene.quanta(x, y), view.exaggeration));
            if (!(glm::distance(place, view.eye_m) < view.soon_m)) continue;
            if (!select::touches(view.picture, view.eye_m, place, 0.0)) continue;
            // Its tile, but for borders, which several have.
            const std::int64_t quads = tree.grid.quads();
            if (x % quads == 0 || y % quads == 0) continue;
            const NodeId node{tree.grid.finest(), static_cast<std::int32_t>(x / quads),
                              static_cast<std::int32_t>(y / quads)};
            if (!tree.has(static_cast<std::size_t>(tree.grid.linear(node)))) continue;
            CHECK(chosen.contains(node));
            ++near;
        }
    }
    CHECK(near > 500);
    CHECK(wanted > 500);
}

TEST_CASE("schedule: nothing seen, nothing wanted") {
    const Scene scene({.width = 150, .height = 100, .seed = 1});
    const GroundBounds ground(scene.info(), scene.records());
    TileSchedule schedule(select::heights_tree(scene.info(), scene.records()), ground, 50);
    GroundView view;
    view.eye_m = {scene.info().world(20, 20), 1e3};
    CHECK(schedule.run(view).tiles.empty());
    view.rectangle = ground.terrain();
    view.pixel_error_px = 0.01;
    CHECK_FALSE(schedule.run(view).tiles.empty());
    GroundMask mask;
    mask.clear(select::GroundLattice(ground.terrain()), glm::dvec2(view.eye_m));
    view.seen = std::span(&mask, 1);
    CHECK(schedule.run(view).tiles.empty());
}

TEST_CASE("ground bounds: no vertex of an area stands outside them") {
    const Scene scene({.width = 150, .height = 100, .seed = 4});
    const GroundBounds ground(scene.info(), scene.records());
    Random random(4);
    for (int i = 0; i < 300; ++i) {
        const GroundRectangle area = random_rectangle(ground.terrain(), 0.3, random);
        const auto bounds = ground.of(area, whole(random, 0, scene.grid().finest()));
        for (int j = 0; j < 30; ++j) {
            const int x = whole(random, 0, 149), y = whole(random, 0, 99);
            const glm::dvec2 at = scene.info().world(x, y);
            if (glm::any(glm::lessThan(at, area.min)) || glm::any(glm::greaterThan(at, area.max))) continue;
            REQUIRE(bounds.has_value());
            CHECK(scene.quanta(x, y) >= bounds->lowest);
            CHECK(scene.quanta(x, y) <= bounds->highest);
        }
    }
}

}  // namespace ridgeline::test
