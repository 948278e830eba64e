// What selection leaves out because the ground in front hides it, against rays marched over the drawn
// surface.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <deque>
#include <limits>
#include <map>
#include <optional>

#include "ridgeline/io/chunk_codec.h"
#include "ridgeline/jobs/job_system.h"
#include "unit/select_scene.h"

namespace ridgeline::test {
namespace {

using io::NodeId;
using select::HorizonMode;
using select::NodeIndex;

// Scenes of hills and mountains; with nodes without data, and with voids in nodes.
const std::deque<Scene>& scenes() {
    static const std::deque<Scene> made = [] {
        std::deque<Scene> list;
        list.emplace_back(SceneShape{.width = 300, .height = 230, .seed = 11, .relief = 2.0});
        list.emplace_back(SceneShape{.width = 450, .height = 390, .seed = 12, .relief = 1.5});
        list.emplace_back(
            SceneShape{.width = 450, .height = 260, .seed = 13, .nodata_share = 0.1, .relief = 2.0});
        list.emplace_back(SceneShape{.width = 300, .height = 290, .seed = 14, .voids = 12, .relief = 2.0});
        return list;
    }();
    return made;
}

// Chunks whose chains stand higher than they may.
class LyingGround final : public select::GroundSource {
  public:
    LyingGround(const Scene& scene, int codes_too_high) : scene_(scene) {
        const io::ChunkShape shape{scene.grid().quads(), scene.info().relief};
        for (std::size_t i = 0; i < scene.records().size(); ++i) {
            const io::NodeRecord& record = scene.records()[i];
            std::vector<io::ChunkVertex> block;
            if (record.has_data()) {
                const std::size_t bytes = io::chunk_layout(record, shape).total;
                block.resize(bytes / sizeof(io::ChunkVertex) + 1);
                std::memcpy(block.data(), scene.chunk(static_cast<NodeIndex>(i)).geometry().data(), bytes);
                lift(io::ChunkView(std::as_writable_bytes(std::span(block)), record, shape).relief(),
                     codes_too_high);
            }
            blocks_.push_back(std::move(block));
        }
    }
    io::ChunkView chunk(std::uint32_t index) const override {
        return {std::as_writable_bytes(std::span(blocks_[index])),
                scene_.records()[index],
                {scene_.grid().quads(), scene_.info().relief}};
    }

  private:
    static void lift(const io::ReliefView& relief, int codes) {
        for (const auto axis : {io::ReliefAxis::east, io::ReliefAxis::south})
            for (int band = 0; band < relief.shape().bands; ++band)
                for (std::uint16_t& code : relief.heights(axis, band))
                    if (code != io::chain_height::kHidesNothing)
                        code = static_cast<std::uint16_t>(std::min(code + codes, 65535));
    }

    const Scene& scene_;
    mutable std::vector<std::vector<io::ChunkVertex>> blocks_;
};

// Near the ground, or over it, looking about level.
select::Camera ground_camera(const Scene& scene, Random& random) {
    const auto& info = scene.info();
    const double x = uniform(random, 0.02, 0.98) * static_cast<double>(info.width - 1);
    const double y = uniform(random, 0.02, 0.98) * static_cast<double>(info.height - 1);
    double ground = -1e9;
    for (int level = 0; level < scene.grid().levels(); ++level)
        for (const int corner : {0, 1, 2, 3})
            ground = std::max(ground, scene.surface(static_cast<std::int64_t>(x) + (corner & 1),
                                                    static_cast<std::int64_t>(y) + (corner >> 1), level));
    select::Camera camera;
    camera.eye_m = {info.world(x, y), info.height_m(ground) + std::exp(uniform(random, 0.3, 5.0))};
    const double heading = uniform(random, 0.0, 6.3), pitch = uniform(random, -0.5, 0.3);
    camera.forward = {std::sin(heading) * std::cos(pitch), std::cos(heading) * std::cos(pitch),
                      std::sin(pitch)};
    camera.right = {std::cos(heading), -std::sin(heading), 0.0};
    camera.up = glm::cross(camera.right, camera.forward);
    camera.horizontal_field = Angle::from_degrees(uniform(random, 20.0, 140.0));
    camera.speed_m_per_s = whole(random, 0, 1) * uniform(random, 0.0, 100.0);
    camera.turn_per_second = Angle::from_degrees(uniform(random, 0.0, 60.0));
    return camera;
}

select::ViewOptions random_options(Random& random, HorizonMode mode) {
    select::ViewOptions options;
    options.pixel_error_px = std::exp(uniform(random, 0.0, 4.0));
    options.horizon = mode;
    return options;
}

select::View ground_view(const Scene& scene, Random& random, HorizonMode mode) {
    const select::Camera camera = ground_camera(scene, random);
    return select::make_view(camera, random_options(random, mode));
}

select::View with(select::View view, HorizonMode mode) {
    view.horizon = mode;
    return view;
}

// The drawn surface on the finest lattice: heights over the eye at its points, and how each cell is cut.
class DrawnHeights {
  public:
    DrawnHeights(const Scene& scene, const select::SelectionResult& result)
        : scene_(scene),
          stride_(scene.grid().nodes_x(0) * scene.grid().extent(0) + 1),
          eye_(glm::dvec2(result.eye.cell) + glm::dvec2(result.eye.cell_rest)),
          rows_(scene.grid().nodes_y(0) * scene.grid().extent(0) + 1) {
        cells_.resize(static_cast<std::size_t>(stride_ * rows_));
        heights_m_.resize(cells_.size());
        for (const Unit& unit : units_of(scene, result.draws)) add(unit, result.eye);
    }

    const glm::dvec2& eye() const { return eye_; }
    bool covered(std::int64_t x, std::int64_t y) const { return cell(x, y).drawn; }
    // At a corner of a drawn cell.
    double height_m(std::int64_t x, std::int64_t y) const { return heights_m_[at(x, y)]; }

    // Whether a ray from the eye meets the surface from above before it has gone the whole way to a place.
    bool hides(const glm::dvec2& place, double height_m) const {
        const glm::dvec2 way = place - eye_;
        std::vector<double> stops = {0.0, 1.0 - 1e-9};
        for (int axis = 0; axis < 2; ++axis) add_stops(stops, eye_[axis], way[axis]);
        add_stops(stops, eye_.x - eye_.y, way.x - way.y);
        add_stops(stops, eye_.x + eye_.y, way.x + way.y);
        std::sort(stops.begin(), stops.end());
        // Within a cell, or from a cell into the next, the surface has no gap: over it at one stop and under
        // it at the next is through it.
        bool over = false;
        for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
            if (stops[i + 1] - stops[i] < 1e-12) continue;
            const glm::dvec2 middle = eye_ + 0.5 * (stops[i] + stops[i + 1]) * way;
            const auto x = static_cast<std::int64_t>(std::floor(middle.x));
            const auto y = static_cast<std::int64_t>(std::floor(middle.y));
            if (x < 0 || y < 0 || x >= stride_ - 1 || y >= rows_ - 1 || !cell(x, y).drawn) {
                over = false;
                continue;
            }
            const double enter = over_surface(x, y, eye_ + stops[i] * way, stops[i] * height_m);
            const double leave = over_surface(x, y, eye_ + stops[i + 1] * way, stops[i + 1] * height_m);
            over = over || enter > 0.0;
            if (over && leave < 0.0) return true;
        }
        return false;
    }

  private:
    struct Cell {
        bool drawn = false;
        bool falling = false;  // cut from north-west to south-east, else the other way
    };
    std::size_t at(std::int64_t x, std::int64_t y) const { return static_cast<std::size_t>(y * stride_ + x); }
    const Cell& cell(std::int64_t x, std::int64_t y) const { return cells_[at(x, y)]; }

    static void add_stops(std::vector<double>& stops, double from, double way) {
        if (std::abs(way) < 1e-9) return;
        const double first = std::ceil(std::min(from, from + way)), last = std::max(from, from + way);
        for (double line = first; line <= last; ++line) {
            const double t = (line - from) / way;
            if (t > 0.0 && t < 1.0) stops.push_back(t);
        }
    }

    // How far a ray at a place of a cell is over the surface; of the border triangles that are fans, about.
    double over_surface(std::int64_t x, std::int64_t y, const glm::dvec2& place, double ray_m) const {
        const double u = std::clamp(place.x - static_cast<double>(x), 0.0, 1.0);
        const double v = std::clamp(place.y - static_cast<double>(y), 0.0, 1.0);
        const double h[4] = {height_m(x, y), height_m(x + 1, y), height_m(x, y + 1), height_m(x + 1, y + 1)};
        double surface = 0.0;
        if (cell(x, y).falling)
            surface = u > v ? h[0] + u * (h[1] - h[0]) + v * (h[3] - h[1])
                            : h[0] + v * (h[2] - h[0]) + u * (h[3] - h[2]);
        else
            surface = u + v < 1.0 ? h[0] + u * (h[1] - h[0]) + v * (h[2] - h[0])
                                  : h[3] + (1.0 - u) * (h[2] - h[3]) + (1.0 - v) * (h[1] - h[3]);
        return ray_m - surface;
    }

    void add(const Unit& unit, const select::EyeFrame& eye) {
        const auto& entry = *unit.entry;
        const auto& chunk = scene_.chunk(entry.index);
        const auto indices = chunk.indices();
        for (const auto& range : select::quarter_ranges(chunk.ranges(), entry, unit.quarter))
            for (std::uint32_t i = range.first; i < range.first + range.count; i += 3) {
                glm::dvec3 p[3];
                for (int k = 0; k < 3; ++k) {
                    const io::ChunkVertex& vertex = chunk.vertices()[indices[i + static_cast<unsigned>(k)]];
                    const io::LatticePoint origin = scene_.grid().origin(entry.node);
                    const auto drawn = select::drawn_vertex(eye, entry.origin, entry.morph, vertex);
                    p[k] = {static_cast<double>(origin.x + vertex.x()),
                            static_cast<double>(origin.y + vertex.y),
                            static_cast<double>(drawn.position_m.z)};
                }
                add_triangle(p, entry.node.level);
            }
    }

    // To every cell of which it covers half.
    void add_triangle(const glm::dvec3 (&p)[3], int level) {
        const glm::dvec3 normal = glm::cross(p[1] - p[0], p[2] - p[0]);
        const auto plane = [&](double x, double y) {
            return p[0].z - (normal.x * (x - p[0].x) + normal.y * (y - p[0].y)) / normal.z;
        };
        const auto inside = [&](double x, double y) {
            for (int k = 0; k < 3; ++k) {
                const glm::dvec3 &a = p[k], &b = p[(k + 1) % 3];
                const double side = (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
                if (side * normal.z < -1e-9) return false;
            }
            return true;
        };
        const auto low_x = static_cast<std::int64_t>(std::min({p[0].x, p[1].x, p[2].x}));
        const auto low_y = static_cast<std::int64_t>(std::min({p[0].y, p[1].y, p[2].y}));
        const auto high_x = static_cast<std::int64_t>(std::max({p[0].x, p[1].x, p[2].x}));
        const auto high_y = static_cast<std::int64_t>(std::max({p[0].y, p[1].y, p[2].y}));
        const std::int64_t step = scene_.grid().step(level);
        for (std::int64_t y = low_y; y <= high_y; ++y)
            for (std::int64_t x = low_x; x <= high_x; ++x) {
                const auto fx = static_cast<double>(x), fy = static_cast<double>(y);
                if (inside(fx, fy)) heights_m_[at(x, y)] = plane(fx, fy);
                // Into which of the cell's four parts the triangle reaches.
                const bool north = inside(fx + 0.5, fy + 0.2), south = inside(fx + 0.5, fy + 0.8);
                const bool west = inside(fx + 0.2, fy + 0.5), east = inside(fx + 0.8, fy + 0.5);
                if (!north && !south && !west && !east) continue;
                if (x >= scene_.info().width - 1 || y >= scene_.info().height - 1 ||
                    !scene_.cell_valid(x / step * step, y / step * step, level))
                    continue;
                Cell& to = cells_[at(x, y)];
                to.drawn = true;
                to.falling = to.falling || (north && east && !west) || (south && west && !east);
            }
    }

    const Scene& scene_;
    std::int64_t stride_ = 0;
    glm::dvec2 eye_{0.0};
    std::int64_t rows_ = 0;
    std::vector<Cell> cells_;
    std::vector<double> heights_m_;  // over the eye, at lattice points
};

bool in_picture(const Scene& scene, const select::View& view, const glm::dvec2& place, double over_eye_m) {
    const glm::dvec3 point(scene.info().world(place.x, place.y), view.eye_m.z + over_eye_m);
    return std::all_of(view.visible.planes.begin(), view.visible.planes.end(), [&](const auto& plane) {
        return glm::dot(plane.normal, point) + plane.offset >= 0.0;
    });
}

struct Verdict {
    int left_out = 0;  // points in the picture that are not drawn
    int seen = 0;      // ... and that nothing drawn hides
};

// Holds what `culled` leaves out of `all` against the surface that `culled` draws.
Verdict judge(const Scene& scene, const select::View& view, const DrawnHeights& all,
              const DrawnHeights& culled) {
    Verdict verdict;
    for (std::int64_t y = 0; y < scene.info().height - 1; ++y)
        for (std::int64_t x = 0; x < scene.info().width - 1; ++x) {
            if (!all.covered(x, y) || culled.covered(x, y) || (x * 7 + y * 13) % 5 != 0) continue;
            const auto corner = (x + y) % 4;
            const std::int64_t px = x + (corner & 1), py = y + (corner >> 1);
            const glm::dvec2 place(static_cast<double>(px), static_cast<double>(py));
            const double height_m = all.height_m(px, py);
            if (!in_picture(scene, view, place, height_m)) continue;
            ++verdict.left_out;
            verdict.seen += !culled.hides(place, height_m);
        }
    return verdict;
}

std::size_t quarters_of(std::span<const select::DrawEntry> draws) {
    std::size_t quarters = 0;
    for (const auto& entry : draws) quarters += static_cast<std::size_t>(std::popcount(entry.quarters));
    return quarters;
}

// Runs until nothing changes, loading what is wanted and visible a few tiles at a time.
int settle(select::Selection& selection, const select::View& view, const select::GroundSource& ground,
           std::vector<io::NodeResidency>& residency, Random& random) {
    for (int step = 1; step < 200; ++step) {
        const auto& result = selection.run(view, residency, &ground);
        bool loaded = false;
        int room = whole(random, 1, 6);
        for (const auto& tile : result.wanted)
            if (tile.visible && !tile.resident && room-- > 0) residency[tile.index].resident = loaded = true;
        if (!loaded && !result.unsettled) return step;
    }
    return 200;
}

bool same(const select::DrawEntry& a, const select::DrawEntry& b) {
    return a.node == b.node && a.origin == b.origin && std::memcmp(&a.morph, &b.morph, sizeof a.morph) == 0;
}

}  // namespace

TEST_CASE("nothing that is seen is left out, with everything there") {
    const auto criterion = select::make_criterion("screen_error").value();
    for (const Scene& scene : scenes()) {
        Random random(5);
        const SceneGround ground(scene);
        const auto residency = all_resident(scene);
        select::Selection selection(scene.info(), scene.records(), *criterion);
        Verdict sum;
        std::size_t drawn = 0, drawn_at_all = 0;
        for (int i = 0; i < 40; ++i) {
            const HorizonMode mode = i % 4 == 3 ? HorizonMode::boxes : HorizonMode::ridges;
            const auto view = ground_view(scene, random, mode);
            const DrawnHeights all(scene, selection.run(with(view, HorizonMode::off), residency, &ground));
            drawn_at_all += quarters_of(selection.result().draws);
            const DrawnHeights culled(scene, selection.run(view, residency, &ground));
            drawn += quarters_of(selection.result().draws);
            const Verdict verdict = judge(scene, view, all, culled);
            sum.left_out += verdict.left_out;
            sum.seen += verdict.seen;
        }
        MESSAGE("drew ", drawn, " quarters of ", drawn_at_all, ", left out ", sum.left_out, " points");
        CHECK(sum.seen == 0);
        CHECK(sum.left_out > 1000);
    }
}

TEST_CASE("chains that stand too high are found out by the rays") {
    const auto criterion = select::make_criterion("screen_error").value();
    const Scene& scene = scenes().front();
    Random random(6);
    const SceneGround ground(scene);
    const LyingGround lying(scene, 3000);
    const auto residency = all_resident(scene);
    select::Selection selection(scene.info(), scene.records(), *criterion);
    int seen = 0;
    for (int i = 0; i < 20; ++i) {
        const auto view = ground_view(scene, random, HorizonMode::ridges);
        const DrawnHeights all(scene, selection.run(with(view, HorizonMode::off), residency, &ground));
        const DrawnHeights culled(scene, selection.run(view, residency, &lying));
        seen += judge(scene, view, all, culled).seen;
    }
    CHECK(seen > 0);
}

TEST_CASE("once settled, what is drawn is what is drawn without the horizon, less what is hidden") {
    const auto criterion = select::make_criterion("screen_error").value();
    int hidden_missing = 0, steps = 0;
    for (const Scene& scene : scenes()) {
        Random random(7);
        const SceneGround ground(scene);
        select::Selection selection(scene.info(), scene.records(), *criterion);
        select::Selection plain(scene.info(), scene.records(), *criterion);
        for (int i = 0; i < 25; ++i) {
            const auto view = ground_view(scene, random, HorizonMode::ridges);
            auto residency = random_residency(scene, random);
            for (auto& node : residency) node.fade = 0.0f;
            steps = std::max(steps, settle(selection, view, ground, residency, random));
            const auto& all = plain.run(with(view, HorizonMode::off), all_resident(scene));
            const auto& some = selection.result();
            hidden_missing += static_cast<int>(some.counters.assumed);
            CHECK(some.counters.missing == 0);
            std::size_t at = 0;
            bool all_found = true;
            for (const auto& entry : some.draws) {
                while (at < all.draws.size() && all.draws[at].node != entry.node) ++at;
                all_found = all_found && at < all.draws.size() && same(entry, all.draws[at]) &&
                            (entry.quarters & ~all.draws[at].quarters) == 0;
            }
            CHECK(all_found);
        }
    }
    CHECK(steps < 150);
    CHECK(hidden_missing > 50);
}

TEST_CASE(
    "while tiles are missing and the eye moves, every point in view is drawn or hidden by what is drawn") {
    const auto criterion = select::make_criterion("screen_error").value();
    std::uint32_t most_assumed = 0;
    for (const Scene& scene : scenes()) {
        Random random(8);
        const SceneGround ground(scene);
        select::Selection selection(scene.info(), scene.records(), *criterion);
        Verdict sum;
        std::uint32_t assumed = 0, rounds = 0;
        for (int flight = 0; flight < 5; ++flight) {
            select::Camera camera = ground_camera(scene, random);
            const auto options = random_options(random, HorizonMode::ridges);
            auto residency = random_residency(scene, random);
            for (int i = 0; i < 5; ++i) {
                const auto view = select::make_view(camera, options);
                const auto& result = selection.run(view, residency, &ground);
                assumed += result.counters.assumed;
                rounds = std::max(rounds, result.counters.horizon_rounds);
                const DrawnHeights culled(scene, result);
                std::vector<NodeIndex> asked;
                for (const auto& tile : result.wanted)
                    if (tile.visible && !tile.resident && asked.size() < 8) asked.push_back(tile.index);
                // What could stand there, as it is drawn when all of it is there.
                select::Selection plain(scene.info(), scene.records(), *criterion);
                const DrawnHeights all(scene, plain.run(with(view, HorizonMode::off), all_resident(scene)));
                const Verdict verdict = judge(scene, view, all, culled);
                sum.left_out += verdict.left_out;
                sum.seen += verdict.seen;
                for (const NodeIndex index : asked) residency[index].resident = true;
                camera.eye_m += glm::dvec3(uniform(random, -60.0, 60.0), uniform(random, -60.0, 60.0),
                                           uniform(random, 0.0, 20.0));
            }
        }
        MESSAGE("assumed ", assumed, ", rounds up to ", rounds);
        CHECK(sum.seen == 0);
        CHECK(sum.left_out > 100);
        most_assumed = std::max(most_assumed, assumed);
    }
    CHECK(most_assumed > 20);
}

TEST_CASE("the number of workers changes nothing") {
    const auto criterion = select::make_criterion("screen_error").value();
    const Scene& scene = scenes()[1];
    const SceneGround ground(scene);
    jobs::JobSystem jobs({.workers = 3});
    select::Selection alone(scene.info(), scene.records(), *criterion);
    select::Selection shared(scene.info(), scene.records(), *criterion, {.jobs = &jobs});
    Random random(9);
    for (int i = 0; i < 60; ++i) {
        const auto view = ground_view(scene, random, HorizonMode::ridges);
        const auto residency = random_residency(scene, random);
        const auto& a = alone.run(view, residency, &ground);
        const auto& b = shared.run(view, residency, &ground);
        REQUIRE(a.draws.size() == b.draws.size());
        bool equal = a.wanted.size() == b.wanted.size() && a.unsettled == b.unsettled;
        for (std::size_t d = 0; d < a.draws.size(); ++d)
            equal = equal && same(a.draws[d], b.draws[d]) && a.draws[d].quarters == b.draws[d].quarters;
        for (std::size_t w = 0; equal && w < a.wanted.size(); ++w)
            equal = a.wanted[w].index == b.wanted[w].index && a.wanted[w].visible == b.wanted[w].visible;
        for (int slice = 0; slice < select::SliceView::kSlices; ++slice)
            equal = equal && std::ranges::equal(alone.horizon_columns(slice), shared.horizon_columns(slice));
        CHECK(equal);
    }
}

TEST_CASE("under the ground, over a void or beside the terrain, nothing is hidden") {
    const auto criterion = select::make_criterion("screen_error").value();
    const Scene& scene = scenes().front();
    const SceneGround ground(scene);
    const auto residency = all_resident(scene);
    select::Selection selection(scene.info(), scene.records(), *criterion);
    Random random(10);
    for (int i = 0; i < 20; ++i) {
        select::Camera camera = ground_camera(scene, random);
        if (i % 2 == 0)
            camera.eye_m.z -= 1000.0;
        else
            camera.eye_m.x = scene.info().min_east_m() - 5.0;
        const auto view = select::make_view(camera, random_options(random, HorizonMode::ridges));
        const std::size_t with_horizon = quarters_of(selection.run(view, residency, &ground).draws);
        CHECK(selection.result().counters.horizon_rounds == 0);
        CHECK(quarters_of(selection.run(with(view, HorizonMode::off), residency).draws) == with_horizon);
    }
}

}  // namespace ridgeline::test
