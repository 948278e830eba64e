// Shadow casters: none that shades a visible point is missing, and none of them is drawn otherwise than in
// view.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <set>

#include "unit/select_scene.h"

namespace ridgeline::test {
namespace {

using select::CasterSet;
using select::DrawEntry;
using select::NodeIndex;

select::SunView random_sun(Random& random, CasterSet casters) {
    select::SunView sun;
    sun.casters = casters;
    const double lowest = whole(random, 0, 1) == 0 ? 0.5 : 20.0;
    sun.axes = select::sun_axes(Angle::from_degrees(uniform(random, -360.0, 360.0)),
                                Angle::from_degrees(uniform(random, lowest, lowest == 0.5 ? 15.0 : 90.0)));
    sun.reach_count = 1;
    return sun;
}

bool in_view(const select::View& view, const glm::dvec3& point_m) {
    return std::ranges::all_of(view.visible.planes, [&](const Frustum::Plane& plane) {
        return glm::dot(plane.normal, point_m) + plane.offset >= 0.0;
    });
}

// The drawn surface all around the eye, by the entries with which a run would draw it.
class DrawnGround {
  public:
    DrawnGround(const Scene& scene, const select::Selection& selection, select::Residency residency,
                const select::View& view)
        : scene_(scene), selection_(selection), residency_(residency), view_(view) {}

    struct Point {
        NodeIndex leaf = 0;
        double height_m = 0.0;
    };
    std::optional<Point> at(const glm::dvec2& east_north_m) {
        const glm::dvec2 place = scene_.info().lattice(east_north_m.x, east_north_m.y);
        DrawEntry entry;
        if (!selection_.entry_at(place.x, place.y, residency_, entry)) return std::nullopt;
        const auto triangle =
            select::locate(scene_.chunk(entry.index), entry, scene_.grid(), place.x, place.y);
        if (!triangle) return std::nullopt;
        return Point{entry.index,
                     view_.eye_m.z + select::drawn_height_m(scene_.chunk(entry.index),
                                                            selection_.result().eye, entry, *triangle)};
    }

  private:
    const Scene& scene_;
    const select::Selection& selection_;
    select::Residency residency_;
    const select::View& view_;
};

// Leaves that a ray of sunlight to a point crosses, found by walking it in small steps.
std::set<NodeIndex> leaves_before(DrawnGround& ground, const Scene& scene, const glm::dvec3& point_m,
                                  const glm::dvec3& towards) {
    constexpr double kStepSamples = 0.5;
    constexpr double kClear_m = 0.05;
    std::set<NodeIndex> crossed;
    const double level = std::hypot(towards.x, towards.y);
    if (level < 1e-3) return crossed;
    const double step_m = kStepSamples * scene.info().spacing_x_m / level;
    const double top_m = select::drawn_bounds(scene.info(), scene.records(), 3.0).max.z;
    // The last place clearly over or under the ground; the ray starts over it.
    bool over = true;
    std::optional<NodeIndex> leaf = ground.at(glm::dvec2(point_m))->leaf;
    for (int i = 1; i < 4000; ++i) {
        const glm::dvec3 at_m = point_m + towards * (step_m * i);
        const auto below = at_m.z > top_m ? std::nullopt : ground.at(glm::dvec2(at_m));
        if (!below) break;
        const double over_m = at_m.z - below->height_m;
        if (below->leaf != leaf) leaf.reset();
        if (std::abs(over_m) < kClear_m) continue;
        // Within one leaf all the way from over to under or back: it was crossed there.
        if (over != (over_m > 0.0) && leaf) crossed.insert(*leaf);
        over = over_m > 0.0;
        leaf = below->leaf;
    }
    return crossed;
}

std::set<NodeIndex> nodes_of(std::span<const select::ShadowCaster> casters) {
    std::set<NodeIndex> nodes;
    for (const auto& caster : casters) nodes.insert(caster.entry.index);
    return nodes;
}

std::set<NodeIndex> nodes_of(std::span<const DrawEntry> draws) {
    std::set<NodeIndex> nodes;
    for (const auto& entry : draws) nodes.insert(entry.index);
    return nodes;
}

struct March {
    int shaded = 0;       // points that lie in some leaf's shadow
    int missing = 0;      // crossed leaves that are no casters
    int out_of_view = 0;  // crossed leaves that are not drawn
};

// Random points of what is drawn, each walked towards the sun.
void march(const Scene& scene, Random& random, const select::Selection& selection,
           select::Residency residency, const select::View& view, March& result) {
    constexpr int kPoints = 12;
    const auto casters = nodes_of(selection.result().casters), drawn = nodes_of(selection.result().draws);
    const auto units = units_of(scene, selection.result().draws);
    DrawnGround ground(scene, selection, residency, view);
    for (int i = 0; i < kPoints && !units.empty(); ++i) {
        const Unit& unit =
            units[static_cast<std::size_t>(whole(random, 0, static_cast<int>(units.size()) - 1))];
        const double column = unit.x + uniform(random, 0.0, 1.0) * unit.side;
        const double row = unit.y + uniform(random, 0.0, 1.0) * unit.side;
        const glm::dvec2 place = scene.info().world(column, row);
        const auto surface = ground.at(place);
        if (!surface || !in_view(view, {place, surface->height_m})) continue;
        const auto crossed = leaves_before(ground, scene, {place, surface->height_m}, view.sun.axes.towards);
        result.shaded += crossed.empty() ? 0 : 1;
        for (const NodeIndex leaf : crossed) {
            result.missing += casters.contains(leaf) ? 0 : 1;
            result.out_of_view += drawn.contains(leaf) ? 0 : 1;
        }
    }
}

bool same(const DrawEntry& a, const DrawEntry& b) {
    return a.index == b.index && a.quarters == b.quarters && a.sides == b.sides && a.origin == b.origin &&
           std::memcmp(&a.morph, &b.morph, sizeof a.morph) == 0;
}

const std::vector<SceneShape> kShapes = {
    {300, 180, 32, 1}, {520, 300, 32, 2}, {300, 700, 32, 3, 0.2}, {420, 420, 32, 4, 0.0, 90}};

}  // namespace

TEST_CASE("no leaf that shades a visible point is missing among the casters") {
    March result;
    for (const SceneShape& shape : kShapes) {
        const Scene scene(shape);
        const auto criterion = select::make_criterion("screen_error").value();
        select::Selection selection(scene.info(), scene.records(), *criterion);
        Random random(shape.seed + 100);
        const auto residency = all_resident(scene);
        for (int i = 0; i < 60; ++i) {
            select::View view = random_view(scene, random);
            view.sun = random_sun(random, CasterSet::pvs);
            selection.run(view, residency);
            march(scene, random, selection, residency, view, result);
        }
    }
    CHECK(result.missing == 0);
    // It would prove little if nothing were shaded, or only by what is drawn anyway.
    CHECK(result.shaded > 200);
    CHECK(result.out_of_view > 40);
    MESSAGE(result.shaded, " shaded points, ", result.out_of_view, " by leaves that are not drawn");
}

TEST_CASE("casters of what is seen are some of all, and drawn the same") {
    std::size_t some = 0, all = 0, in_sight = 0;
    for (const SceneShape& shape : kShapes) {
        const Scene scene(shape);
        const auto criterion = select::make_criterion("screen_error").value();
        select::Selection selection(scene.info(), scene.records(), *criterion);
        Random random(shape.seed);
        for (int i = 0; i < 60; ++i) {
            const auto residency = random_residency(scene, random);
            select::View view = random_view(scene, random);
            view.sun = random_sun(random, CasterSet::all);
            selection.run(view, residency);
            std::map<NodeIndex, DrawEntry> entries;
            for (const auto& caster : selection.result().casters) entries[caster.entry.index] = caster.entry;
            all += entries.size();
            view.sun.casters = CasterSet::pvs;
            const auto& result = selection.run(view, residency);
            some += result.casters.size();
            in_sight += result.draws.size();
            for (const auto& caster : result.casters) {
                REQUIRE(entries.contains(caster.entry.index));
                DrawEntry whole_entry = entries[caster.entry.index];
                // Where a child is missing, the quarter that stands for it may cast nothing.
                CHECK((caster.entry.quarters & ~whole_entry.quarters) == 0);
                if (caster.entry.quarters == whole_entry.quarters) CHECK(same(caster.entry, whole_entry));
                CHECK(residency[caster.entry.index].resident);
            }
            const auto casters = nodes_of(result.casters);
            for (const DrawEntry& entry : result.draws) CHECK(casters.contains(entry.index));
        }
    }
    CHECK(some < all);
    MESSAGE(all, " leaves, ", some, " of them casters, ", in_sight, " drawn");
}

TEST_CASE("all casters together are the whole terrain, once") {
    const Scene scene({520, 300, 32, 5});
    const auto criterion = select::make_criterion("screen_error").value();
    select::Selection selection(scene.info(), scene.records(), *criterion);
    Random random(5);
    for (int i = 0; i < 60; ++i) {
        select::View view = random_view(scene, random);
        view.sun = random_sun(random, CasterSet::all);
        const auto& result = selection.run(view, random_residency(scene, random));
        std::vector<DrawEntry> entries;
        for (const auto& caster : result.casters) entries.push_back(caster.entry);
        std::int64_t covered = 0, there = 0;
        for (const Unit& unit : units_of(scene, entries)) covered += unit.side * unit.side;
        const std::int64_t half = scene.grid().extent(scene.grid().finest()) / 2;
        for (std::int64_t y = 0; y < scene.grid().height() - 1; y += half)
            for (std::int64_t x = 0; x < scene.grid().width() - 1; x += half) there += half * half;
        // Coarse quarters reach past the raster's border.
        CHECK(covered >= there);
        std::set<std::pair<std::int64_t, std::int64_t>> corners;
        for (const Unit& unit : units_of(scene, entries)) CHECK(corners.insert({unit.x, unit.y}).second);
    }
}

TEST_CASE("shadows change nothing of what is drawn, and only add to what is wanted") {
    const Scene scene({520, 300, 32, 6});
    const auto criterion = select::make_criterion("screen_error").value();
    select::Selection selection(scene.info(), scene.records(), *criterion);
    Random random(6);
    bool added = false;
    for (int i = 0; i < 80; ++i) {
        const auto residency = random_residency(scene, random);
        select::View view = random_view(scene, random);
        const auto& plain = selection.run(view, residency);
        CHECK(plain.casters.empty());
        const std::vector<DrawEntry> draws(plain.draws.begin(), plain.draws.end());
        std::vector<NodeIndex> wanted, visible;
        for (const auto& tile : plain.wanted) (tile.visible ? visible : wanted).push_back(tile.index);
        view.sun = random_sun(random, CasterSet::pvs);
        const auto& shaded = selection.run(view, residency);
        REQUIRE(shaded.draws.size() == draws.size());
        for (std::size_t k = 0; k < draws.size(); ++k) CHECK(same(shaded.draws[k], draws[k]));
        std::vector<NodeIndex> now_visible;
        std::set<NodeIndex> now_wanted;
        for (const auto& tile : shaded.wanted) {
            if (tile.visible) now_visible.push_back(tile.index);
            CHECK(now_wanted.insert(tile.index).second);
        }
        CHECK(now_visible == visible);
        for (const NodeIndex index : wanted) CHECK(now_wanted.contains(index));
        added = added || now_wanted.size() > wanted.size() + visible.size();
        for (const auto& caster : shaded.casters) CHECK(now_wanted.contains(caster.entry.index));
    }
    CHECK(added);
}

TEST_CASE("what is drawn or shades it is kept") {
    const Scene scene({520, 300, 32, 7});
    const auto criterion = select::make_criterion("screen_error").value();
    select::Selection selection(scene.info(), scene.records(), *criterion);
    Random random(7);
    for (int i = 0; i < 60; ++i) {
        select::View view = random_view(scene, random);
        view.sun = random_sun(random, CasterSet::pvs);
        const auto& result = selection.run(view, random_residency(scene, random));
        const std::set<NodeIndex> used(result.used.begin(), result.used.end());
        CHECK(used.size() == result.used.size());
        for (const auto& caster : result.casters) {
            CHECK(used.contains(caster.entry.index));
            io::NodeId node = caster.entry.node;
            for (; node.level > 0; node = node.parent())
                CHECK(used.contains(static_cast<NodeIndex>(scene.grid().linear(node.parent()))));
        }
    }
}

TEST_CASE("light axes are perpendicular, and a ray keeps its place across them") {
    Random random(8);
    for (int i = 0; i < 1000; ++i) {
        const auto axes = random_sun(random, CasterSet::all).axes;
        CHECK(std::abs(glm::dot(axes.across, axes.along)) < 1e-12);
        CHECK(std::abs(glm::dot(axes.across, axes.towards)) < 1e-12);
        CHECK(glm::length(glm::cross(axes.across, axes.along) - axes.towards) < 1e-12);
        Box box{{uniform(random, -9, 0), uniform(random, -9, 0), uniform(random, -9, 0)}, {}};
        box.max = box.min + glm::dvec3(uniform(random, 0, 9), uniform(random, 0, 9), uniform(random, 0, 9));
        const glm::dvec3 eye(uniform(random, -9, 9), uniform(random, -9, 9), uniform(random, -9, 9));
        const select::SunBox bounds = select::sun_box(axes, eye, box);
        const glm::dvec3 share(uniform(random, 0, 1), uniform(random, 0, 1), uniform(random, 0, 1));
        const glm::dvec3 inside = glm::mix(box.min, box.max, share) - eye;
        const glm::dvec3 seen(glm::dot(axes.across, inside), glm::dot(axes.along, inside),
                              glm::dot(axes.towards, inside));
        for (int k = 0; k < 3; ++k)
            CHECK((seen[k] >= bounds.min[k] - 1e-9 && seen[k] <= bounds.max[k] + 1e-9));
    }
}

}  // namespace ridgeline::test
