// What --criterion and --pixel-error promise of the quadtree's cells, held against doubles: no cell is coarser than
// promised, but where its tile has nothing finer, and none is finer for no reason. And that balancing comes to rest
// within the passes that it is given, whatever the order.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "ridgeline/select/criterion.h"
#include "ridgeline/shaders/lib/quadtree_balance.h"
#include "unit/render_quadtree_scene.h"

using namespace ridgeline;
using namespace ridgeline::render;
using namespace ridgeline::test;

namespace {

// Floats lose so much of a distance's square and of a switching distance's.
constexpr double kRounded = 1e-5;

struct Promise {
    const char* criterion;
    select::CriterionOptions options;
    double projection_px, pixel_error_px;
};

Promise random_promise(Random& random) {
    constexpr std::array kNames = {"screen_error", "roughness", "distance"};
    const auto between = [&](float from, float to) { return static_cast<double>(real(random, from, to)); };
    return {kNames[static_cast<std::size_t>(whole(random, 0, 2))],
            {.distance_factor = between(1, 6),
             .roughness_factor = between(0.5f, 4),
             .roughness_weight = between(10, 300)},
            between(100, 2000),
            std::exp(between(-3, 3))};
}

// A cell: the samples from its corner on, of a block that it lies in.
struct Cell {
    const shaders::QuadtreeBlock& block;
    glm::ivec2 place;
    int level;

    int depth() const { return block.coarseness + shaders::kQuadtreeDepth - level; }
    Cell parent() const { return {block, place, level + 1}; }
};

// The same in the block whose tile it is drawn with: its own, or that of the nearest ancestor which has one.
Cell by_tile(const LodScene& scene, const Cell& cell) {
    if (shaders::has_own_tile(cell.block)) return cell;
    const auto& above = scene.blocks.blocks()[static_cast<std::size_t>(cell.block.above)];
    const int up = above.coarseness - cell.block.coarseness, within = (1 << up) - 1;
    const glm::ivec2 first((cell.block.node.x & within) * shaders::kQuadtreeSide,
                           (cell.block.node.y & within) * shaders::kQuadtreeSide);
    return {above, {(first.x + cell.place.x) >> up, (first.y + cell.place.y) >> up}, cell.level};
}

// A scene under a promise, all in doubles.
class Judge {
  public:
    Judge(const LodScene& scene, const Promise& promise) : scene_(scene), promise_(promise) {}

    glm::ivec2 corner(const Cell& cell) const {
        const int shift = shaders::kQuadtreeDepth - cell.depth();
        const glm::ivec2 first((cell.place.x >> shift) << shift, (cell.place.y >> shift) << shift);
        return (cell.block.node * shaders::kQuadtreeSide + first) * (1 << shift_of(cell.block.coarseness));
    }
    int side(const Cell& cell) const { return 1 << shift_of(cell.level); }

    // By how much a cell exceeds what is promised: above 1 it must be divided.
    double excess(const Cell& cell) const {
        const double away_m = distance_m(cell), error_m = this->error_m(cell);
        const glm::dvec2 spacing_m(scene_.view.scale);
        const double side_m = side(cell) * std::max(spacing_m.x, spacing_m.y);
        const std::string_view criterion = promise_.criterion;
        const auto& options = promise_.options;
        // Pixels by tolerated pixels; or sides, or weighted errors, by distance.
        if (criterion == "screen_error")
            return error_m * promise_.projection_px / away_m / promise_.pixel_error_px;
        if (criterion == "distance")
            return options.distance_factor * side_m / away_m / promise_.pixel_error_px;
        const double weighted_m = std::max(side_m, options.roughness_weight * error_m);
        return options.roughness_factor * weighted_m / away_m / promise_.pixel_error_px;
    }

    // Whether cells about it, or within it, are so fine that it could not stand between them.
    bool is_forbidden(const Cell& cell) const {
        const glm::ivec2 from = corner(cell);
        const int step = 1 << shift_of(0), size = side(cell);
        for (int y = from.y - step; y < from.y + size + step; y += step)
            for (int x = from.x - step; x < from.x + size + step; x += step) {
                const int level = scene_.level_at({x, y});
                if (level >= 0 && level < cell.level - 1) return true;
            }
        return false;
    }

  private:
    int shift_of(int level) const { return level + scene_.view.eye_cell.w; }
    double error_m(const Cell& cell) const {
        const auto& shape = scene_.shapes[shaders::block_slot(cell.block)];
        return shape.error[shaders::shape_index(cell.place, cell.depth())] *
               static_cast<double>(scene_.view.eye_rest.w);
    }
    // To the box of the cell's ground and its tile's heights.
    double distance_m(const Cell& cell) const {
        const auto& view = scene_.view;
        const auto& shape = scene_.shapes[shaders::block_slot(cell.block)];
        const glm::dvec2 eye = glm::dvec2(view.eye_cell) + glm::dvec2(view.eye_rest);
        const glm::dvec2 least(corner(cell)), most = least + static_cast<double>(side(cell));
        const double eye_sixteenths = 16.0 * (view.eye_cell.z + static_cast<double>(view.eye_rest.z));
        const glm::dvec3 away(glm::max(glm::max(least - eye, eye - most), 0.0) * glm::dvec2(view.scale),
                              std::max({shape.least - eye_sixteenths, eye_sixteenths - shape.most, 0.0}) *
                                  static_cast<double>(view.eye_rest.w));
        return glm::length(away);
    }

    const LodScene& scene_;
    const Promise& promise_;
};

void look_by(LodScene& scene, const Promise& promise) {
    select::View view;
    view.projection_px = promise.projection_px;
    view.pixel_error_px = promise.pixel_error_px;
    const auto criterion = select::make_criterion(promise.criterion, promise.options).value();
    const auto rule = criterion->cell_rule(view, 1 << scene.view.eye_cell.w);
    scene.view.scale.z = static_cast<float>(rule.by_error);
    scene.view.scale.w = static_cast<float>(rule.by_spacing);
    scene.lod.run(scene.view, scene.blocks, scene.shapes);
}

struct Judged {
    std::int64_t cells = 0, coarser = 0, needless = 0, divided = 0, for_balance = 0;
    double most_excess = 0.0;
};

// Of each drawn cell.
template <class Visit>
void for_each_cell(const LodScene& scene, Visit visit) {
    const auto blocks = scene.blocks.blocks();
    for (std::size_t b = 0; b < blocks.size(); ++b)
        for (int e = 0; e < shaders::kQuadtreeEntries; ++e) {
            const glm::ivec2 place = shaders::entry_place(e);
            const int level = scene.lod.level(static_cast<int>(b) * shaders::kQuadtreeEntries + e);
            if (shaders::has_entry(blocks[b], place) && shaders::is_corner(blocks[b], place, level))
                visit(Cell{blocks[b], place, level});
        }
}

void judge(const LodScene& scene, const Promise& promise, Judged& judged) {
    const Judge judge(scene, promise);
    for_each_cell(scene, [&](const Cell& cell) {
        ++judged.cells;
        const Cell tile_cell = by_tile(scene, cell);
        if (tile_cell.depth() < shaders::kQuadtreeDepth) {
            const double excess = judge.excess(tile_cell);
            judged.most_excess = std::max(judged.most_excess, excess);
            judged.coarser += excess > 1.0 + kRounded;
        }
        if (cell.depth() <= shaders::least_depth(cell.block)) return;
        ++judged.divided;
        const Cell parent = tile_cell.parent();
        if (parent.depth() < shaders::kQuadtreeDepth && judge.excess(parent) > 1.0 - kRounded) return;
        const bool forbidden = judge.is_forbidden(cell.parent());
        judged.for_balance += forbidden;
        judged.needless += !forbidden;
    });
}

}  // namespace

TEST_CASE(
    "no cell shows more than the tolerated error but where its tile has nothing finer, and none is finer "
    "than that "
    "and its neighbours need") {
    Random random(21);
    Judged judged;
    for (int round = 0; round < 150; ++round) {
        LodScene scene(random);
        const Promise promise = random_promise(random);
        look_by(scene, promise);
        judge(scene, promise, judged);
    }
    MESSAGE(judged.cells, " cells, at most ", judged.most_excess, " of the tolerated error; ", judged.divided,
            " made by dividing, ", judged.for_balance, " of them for balance");
    CHECK(judged.coarser == 0);
    CHECK(judged.needless == 0);
    CHECK(judged.most_excess > 0.99);
    CHECK(judged.divided > 20000);
    CHECK(judged.for_balance > 1000);
}

namespace {

// The GPU's balancing at its slowest: no entry sees in a pass what others do in it.
struct SlowestBalance {
    const LodScene& scene;
    std::vector<int> before, after;

    const shaders::QuadtreeBlock& block(int i) const { return scene.lod.block(i); }
    const shaders::QuadtreePlace& place(std::uint32_t i) const { return scene.lod.place(i); }
    int level(int i) const { return before[static_cast<std::size_t>(i)]; }
    bool lower(int i, int level) {
        int& held = after[static_cast<std::size_t>(i)];
        if (level >= held) return false;
        held = level;
        return true;
    }

    void ask() {
        before = scene.asked_levels();
        after = before;
    }
    bool pass() {
        bool changed = false;
        for (std::size_t i = 0; i < before.size(); ++i)
            changed = shaders::balance_entry(
                          *this, scene.view, static_cast<int>(i / shaders::kQuadtreeEntries),
                          shaders::entry_place(static_cast<int>(i % shaders::kQuadtreeEntries))) ||
                      changed;
        before = after;
        return changed;
    }
};

// Two levels or more apart, side by side or by a corner, in whatever blocks.
int far_apart(const LodScene& scene, SlowestBalance& balance) {
    const int step = 1 << scene.view.eye_cell.w;
    const glm::ivec2 size =
        static_cast<int>(scene.grid.extent(0)) * glm::ivec2(scene.grid.nodes_x(0), scene.grid.nodes_y(0));
    const auto level_at = [&](const glm::ivec2& sample) {
        const auto at = shaders::entry_of(balance, scene.view, sample);
        return at.block < 0
                   ? -1
                   : balance.level(at.block * shaders::kQuadtreeEntries + shaders::entry_at(at.place));
    };
    int found = 0;
    for (int y = 0; y < size.y; y += step)
        for (int x = 0; x < size.x; x += step)
            for (const glm::ivec2 way : {glm::ivec2(1, 0), {0, 1}, {1, 1}, {-1, 1}}) {
                const int mine = level_at({x, y}), other = level_at(glm::ivec2(x, y) + step * way);
                found += mine >= 0 && other >= 0 && std::abs(mine - other) > 1;
            }
    return found;
}

// Flat, but for the finest cell at a place, and with no tiles but those that lead there: as steep as levels can be.
LodScene lone_peak(Random& random) {
    const int quads = 32, most = quads << whole(random, 1, 6);
    LodScene scene(io::Grid(most + 1, most + 1, quads), random);
    // Beside a border of large cells they are nearest.
    const int size = quads << whole(random, 0, 5);
    const auto beside = [&] {
        return std::clamp(whole(random, 0, most / size) * size - whole(random, 0, 1), 0, most - 1);
    };
    const glm::ivec2 peak(beside(), beside());
    scene.tiles.clear();
    for (int level = 0; level <= scene.grid.finest(); ++level) {
        const auto extent = static_cast<int>(scene.grid.extent(level));
        scene.tiles.push_back({{level, peak.x / extent, peak.y / extent}, static_cast<std::uint32_t>(level)});
    }
    scene.shapes.assign(scene.tiles.size(), {});
    for (int depth = 0; depth < shaders::kQuadtreeDepth; ++depth)
        scene.shapes.back()
            .error[shaders::shape_index((peak % quads) / (quads / shaders::kQuadtreeSide), depth)] =
            1 << (28 - depth);
    scene.view.scale.w = 0.0f;
    scene.build();
    scene.view.blocks.x = scene.blocks.place_bits();
    return scene;
}

}  // namespace

TEST_CASE(
    "balancing has come to rest within its passes in the slowest order, and neighbours are then within a "
    "level") {
    Random random(22);
    int most = 0, allowed = 0;
    double closest = 0.0;
    for (int round = 0; round < 150; ++round) {
        LodScene scene = round % 2 == 0 ? LodScene(random) : lone_peak(random);
        scene.lod.run(scene.view, scene.blocks, scene.shapes);
        SlowestBalance balance{scene, {}, {}};
        balance.ask();
        const int limit = most_balance_passes(scene.view.blocks.y);
        int passes = 0;
        while (passes < limit && balance.pass()) ++passes;
        CAPTURE(round);
        REQUIRE(far_apart(scene, balance) == 0);
        REQUIRE(std::ranges::equal(balance.before, scene.lod.levels()));
        if (static_cast<double>(passes) / limit > closest) {
            closest = static_cast<double>(passes) / limit;
            most = passes;
            allowed = limit;
        }
    }
    MESSAGE("at most ", most, " passes that changed something, of ", allowed);
}
