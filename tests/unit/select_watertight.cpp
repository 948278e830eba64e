// Adjacent drawn quarters meet in the same points, bit for bit: whatever the view, the data at hand, the
// fades.
#include <doctest/doctest.h>

#include <algorithm>
#include <deque>
#include <functional>
#include <map>
#include <tuple>

#include "unit/select_scene.h"

namespace ridgeline::test {
namespace {

using io::Side;
using select::BorderPoint;
using select::DrawEntry;
using select::SideUse;
using Polyline = std::vector<BorderPoint>;

const SceneShape kShapes[] = {{600, 530, 32, 1},       {129, 129, 32, 2},      {257, 513, 32, 3, 0.2},
                              {1100, 270, 32, 4},      {66, 34, 32, 5},        {520, 515, 64, 6},
                              {450, 390, 32, 7, 0.35}, {130, 450, 32, 8, 0.1}, {390, 300, 32, 9, 0.0, 10}};

// Made once; making one takes longer than a thousand selections in it.
const std::deque<Scene>& scenes() {
    static const std::deque<Scene> made(std::begin(kShapes), std::end(kShapes));
    return made;
}

Polyline border(const Scene& scene, const select::EyeFrame& eye, const Unit& unit, Side side) {
    Polyline points;
    select::border_polyline(scene.chunk(unit.entry->index), eye, *unit.entry, scene.grid(), unit.quarter,
                            side, points);
    return points;
}

// The place along the border: row or column.
std::int64_t along(const BorderPoint& point, Side side) {
    return side == Side::east ? point.place.y : point.place.x;
}

Polyline part(const Polyline& points, Side side, std::int64_t from, std::int64_t to) {
    Polyline kept;
    std::copy_if(points.begin(), points.end(), std::back_inserter(kept), [&](const BorderPoint& point) {
        return along(point, side) >= from && along(point, side) <= to;
    });
    return kept;
}

struct Seams {
    int compared = 0;
    int open = 0;
    int levels_crossed = 0;
    int levels_apart = 0;  // the worst
};

// Compares `unit`'s eastern or southern side with all who lie beyond it.
void compare_side(const Scene& scene, const select::EyeFrame& eye, const std::vector<Unit>& units,
                  const Unit& unit, Side side, Seams& seams) {
    const bool east = side == Side::east;
    const Polyline own = border(scene, eye, unit, side);
    for (const Unit& other : units) {
        if (east ? other.x != unit.x + unit.side : other.y != unit.y + unit.side) continue;
        const std::int64_t from = std::max(east ? unit.y : unit.x, east ? other.y : other.x);
        const std::int64_t to =
            std::min((east ? unit.y : unit.x) + unit.side, (east ? other.y : other.x) + other.side);
        if (from >= to) continue;
        const Polyline theirs = border(scene, eye, other, opposite(side));
        const int apart = std::abs(unit.entry->node.level - other.entry->node.level);
        ++seams.compared;
        seams.levels_crossed += apart != 0;
        seams.levels_apart = std::max(seams.levels_apart, apart);
        seams.open += part(own, side, from, to) != part(theirs, side, from, to);
    }
}

Seams seams_of(const Scene& scene, const select::EyeFrame& eye, std::span<const DrawEntry> draws) {
    Seams seams;
    const auto units = units_of(scene, draws);
    for (const Unit& unit : units)
        for (const Side side : {Side::east, Side::south}) compare_side(scene, eye, units, unit, side, seams);
    return seams;
}

// Every point of every border, wherever it is drawn from, lies in one place in space.
int points_in_two_places(const Scene& scene, const select::EyeFrame& eye, std::span<const DrawEntry> draws) {
    std::map<std::pair<std::int64_t, std::int64_t>, glm::vec3> seen;
    int wrong = 0;
    for (const Unit& unit : units_of(scene, draws))
        for (const Side side : {Side::west, Side::east, Side::north, Side::south})
            for (const BorderPoint& point : border(scene, eye, unit, side)) {
                const auto [it, fresh] = seen.try_emplace({point.place.x, point.place.y}, point.position_m);
                wrong += !fresh && it->second != point.position_m;
            }
    return wrong;
}

struct Tally {
    int views = 0;
    Seams seams;
    int points_apart = 0;
};

using Sabotage = std::function<void(const Scene&, std::vector<DrawEntry>&)>;

Tally tally(int views_per_scene, std::uint64_t seed, const Sabotage& sabotage) {
    Tally sum;
    for (const Scene& scene : scenes()) {
        Random random(seed++);
        for (const char* name : {"screen_error", "distance", "roughness", "density"}) {
            const auto criterion = select::make_criterion(name).value();
            select::Selection selection(scene.info(), scene.records(), *criterion);
            for (int i = 0; i < views_per_scene / 4; ++i) {
                const auto view =
                    whole(random, 0, 3) == 0 ? view_of_all(scene, random) : random_view(scene, random);
                const auto residency = random_residency(scene, random);
                const auto& result = selection.run(view, residency);
                std::vector<DrawEntry> draws(result.draws.begin(), result.draws.end());
                sabotage(scene, draws);
                const Seams seams = seams_of(scene, result.eye, draws);
                ++sum.views;
                sum.seams.compared += seams.compared;
                sum.seams.open += seams.open;
                sum.seams.levels_crossed += seams.levels_crossed;
                sum.seams.levels_apart = std::max(sum.seams.levels_apart, seams.levels_apart);
                sum.points_apart += points_in_two_places(scene, result.eye, draws);
            }
        }
    }
    return sum;
}

void leave(const Scene&, std::vector<DrawEntry>&) {}

// Twice the area, in samples, of the triangles that draw a quarter; negative triangles count against it.
std::int64_t twice_drawn_area(const Scene& scene, const Unit& unit, bool& all_turn_left) {
    const auto& chunk = scene.chunk(unit.entry->index);
    std::int64_t area = 0;
    for (const auto& range : select::quarter_ranges(chunk.ranges(), *unit.entry, unit.quarter))
        for (std::uint32_t i = range.first; i < range.first + range.count; i += 3) {
            std::int64_t x[3], y[3];
            for (std::uint32_t k = 0; k < 3; ++k) {
                x[k] = chunk.vertices()[chunk.indices()[i + k]].x();
                y[k] = chunk.vertices()[chunk.indices()[i + k]].y;
            }
            const std::int64_t twice = (x[2] - x[0]) * (y[1] - y[0]) - (x[1] - x[0]) * (y[2] - y[0]);
            all_turn_left = all_turn_left && twice > 0;
            area += twice;
        }
    return area;
}

}  // namespace

TEST_CASE(
    "borders of adjacent drawn quarters are equal as sequences of points, for random views, data and fades") {
    const Tally sum = tally(400, 100, leave);
    MESSAGE(sum.views, " views, ", sum.seams.compared, " seams, ", sum.seams.levels_crossed,
            " between levels");
    CHECK(sum.seams.open == 0);
    CHECK(sum.points_apart == 0);
    CHECK(sum.seams.levels_apart <= 1);
    CHECK(sum.seams.compared > 100000);
    CHECK(sum.seams.levels_crossed > 20000);
}

TEST_CASE("the comparison of borders can fail: each part of the scheme left out opens seams") {
    SUBCASE("no fans") {
        const Tally sum = tally(8, 200, [](const Scene&, std::vector<DrawEntry>& draws) {
            for (auto& entry : draws)
                for (auto& quarter : entry.sides)
                    for (auto& side : quarter) side = side == SideUse::fan ? SideUse::plain : side;
        });
        CHECK(sum.seams.open > 0);
    }
    SUBCASE("an edge with its own node's range") {
        const Tally sum = tally(8, 300, [](const Scene&, std::vector<DrawEntry>& draws) {
            for (auto& entry : draws)
                for (int c = io::vertex_class::outer(Side::west, 0); c < io::vertex_class::inner(0); ++c)
                    entry.morph[static_cast<std::size_t>(c)] = entry.morph[io::vertex_class::kInterior];
        });
        CHECK(sum.seams.open > 0);
        CHECK(sum.points_apart > 0);
    }
    SUBCASE("an edge with its own node's fade") {
        const Tally sum = tally(8, 400, [](const Scene&, std::vector<DrawEntry>& draws) {
            for (auto& entry : draws)
                for (auto& morph : entry.morph)
                    if (morph.fade > 0.0f) morph.fade = entry.morph[io::vertex_class::kInterior].fade;
        });
        CHECK(sum.seams.open > 0);
    }
    SUBCASE("midpoints that move with their half edges") {
        const Tally sum = tally(960, 500, [](const Scene&, std::vector<DrawEntry>& draws) {
            for (auto& entry : draws)
                for (const Side side : {Side::west, Side::east, Side::north, Side::south})
                    entry.morph[static_cast<std::size_t>(io::vertex_class::midpoint(side))] =
                        entry.morph[static_cast<std::size_t>(io::vertex_class::outer(side, 0))];
        });
        CHECK(sum.points_apart > 0);
    }
    SUBCASE("inner lines that move beside a child") {
        const Tally sum = tally(8, 600, [](const Scene&, std::vector<DrawEntry>& draws) {
            for (auto& entry : draws)
                for (int line = 0; line < 4; ++line)
                    entry.morph[static_cast<std::size_t>(io::vertex_class::inner(line))] =
                        entry.morph[io::vertex_class::kInterior];
        });
        CHECK(sum.seams.open > 0);
    }
}

TEST_CASE("the triangles of every drawn quarter tile its square") {
    Random random(1);
    for (const Scene& scene : scenes()) {
        const auto criterion = select::make_criterion("screen_error").value();
        select::Selection selection(scene.info(), scene.records(), *criterion);
        for (int i = 0; i < 20; ++i) {
            const auto residency = random_residency(scene, random);
            const auto& result = selection.run(view_of_all(scene, random), residency);
            bool all_turn_left = true;
            int wrong = 0;
            for (const Unit& unit : units_of(scene, result.draws))
                wrong += twice_drawn_area(scene, unit, all_turn_left) != 2 * unit.side * unit.side;
            CHECK(wrong == 0);
            CHECK(all_turn_left);
        }
    }
}

}  // namespace ridgeline::test
