// What selection tells of a run to those who picture it: the fate of every place, and the horizon by azimuth.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <numbers>

#include "ridgeline/select/horizon_profile.h"
#include "unit/select_scene.h"

namespace ridgeline::test {
namespace {

using select::HorizonMode;
using select::NodeFate;
using select::NodeReport;

const std::deque<Scene>& scenes() {
    static const std::deque<Scene> made = [] {
        std::deque<Scene> list;
        list.emplace_back(SceneShape{.width = 300, .height = 230, .seed = 21, .relief = 2.0});
        list.emplace_back(
            SceneShape{.width = 450, .height = 260, .seed = 22, .nodata_share = 0.1, .relief = 2.0});
        list.emplace_back(SceneShape{.width = 200, .height = 410, .seed = 23, .voids = 9, .relief = 1.5});
        return list;
    }();
    return made;
}

// Two metres to some hundred over the ground, or in a valley's side; about level.
select::View low_view(const Scene& scene, Random& random, HorizonMode mode) {
    const auto& info = scene.info();
    const double x = uniform(random, 0.05, 0.95) * static_cast<double>(info.width - 1);
    const double y = uniform(random, 0.05, 0.95) * static_cast<double>(info.height - 1);
    double ground = -1e9;
    for (int level = 0; level < scene.grid().levels(); ++level)
        for (const double dx : {-1.0, 0.0, 1.0, 2.0})
            for (const double dy : {-1.0, 0.0, 1.0, 2.0})
                ground =
                    std::max(ground, scene.surface(std::max<std::int64_t>(std::llround(x + dx), 0),
                                                   std::max<std::int64_t>(std::llround(y + dy), 0), level));
    select::Camera camera;
    camera.eye_m = {info.world(x, y), info.height_m(ground) + std::exp(uniform(random, 0.7, 4.0))};
    const double heading = uniform(random, 0.0, 6.3), pitch = uniform(random, -0.4, 0.2);
    camera.forward = {std::sin(heading) * std::cos(pitch), std::cos(heading) * std::cos(pitch),
                      std::sin(pitch)};
    camera.right = {std::cos(heading), -std::sin(heading), 0.0};
    camera.up = glm::cross(camera.right, camera.forward);
    camera.speed_m_per_s = whole(random, 0, 1) * 60.0;
    select::ViewOptions options;
    options.pixel_error_px = std::exp(uniform(random, 0.0, 3.0));
    options.horizon = mode;
    return select::make_view(camera, options);
}

// How often each square of half a finest node's side is told of.
class Coverage {
  public:
    explicit Coverage(const Scene& scene)
        : scene_(scene),
          half_(scene.grid().extent(scene.grid().finest()) / 2),
          stride_(scene.grid().nodes_x(0) * scene.grid().extent(0) / half_),
          rows_(scene.grid().nodes_y(0) * scene.grid().extent(0) / half_),
          counts_(static_cast<std::size_t>(stride_ * rows_), 0) {}

    void add(const NodeReport& report) {
        const io::Grid& grid = scene_.grid();
        const std::int64_t side = grid.extent(report.node.level) / 2 / half_;
        const io::LatticePoint origin = grid.origin(report.node);
        for (int q = 0; q < io::kQuarters; ++q) {
            if ((report.quarters >> q & 1) == 0) continue;
            for (std::int64_t y = 0; y < side; ++y)
                for (std::int64_t x = 0; x < side; ++x)
                    ++counts_[static_cast<std::size_t>((origin.y / half_ + (q >> 1) * side + y) * stride_ +
                                                       origin.x / half_ + (q & 1) * side + x)];
        }
    }
    // Never twice, and once wherever the finest node has data and the raster reaches.
    bool exact() const {
        const io::Grid& grid = scene_.grid();
        for (std::int64_t y = 0; y < rows_; ++y)
            for (std::int64_t x = 0; x < stride_; ++x) {
                const int count = counts_[static_cast<std::size_t>(y * stride_ + x)];
                if (count > 1) return false;
                if (x * half_ >= grid.width() - 1 || y * half_ >= grid.height() - 1) continue;
                const io::NodeId node{grid.finest(), static_cast<std::int32_t>(x / 2),
                                      static_cast<std::int32_t>(y / 2)};
                const auto index = static_cast<std::size_t>(grid.linear(node));
                if (count == 0 && scene_.records()[index].has_data()) return false;
            }
        return true;
    }

  private:
    const Scene& scene_;
    std::int64_t half_, stride_, rows_;
    std::vector<int> counts_;
};

std::map<std::int64_t, unsigned> drawn_quarters(const Scene& scene, const std::vector<NodeReport>& nodes) {
    std::map<std::int64_t, unsigned> drawn;
    for (const NodeReport& report : nodes)
        if (report.drawn != 0) drawn[scene.grid().linear(report.node)] |= report.drawn;
    return drawn;
}

std::map<std::int64_t, unsigned> drawn_quarters(const select::SelectionResult& result) {
    std::map<std::int64_t, unsigned> drawn;
    for (const auto& entry : result.draws) drawn[entry.index] = entry.quarters;
    return drawn;
}

// What a fate says about the bits beside it.
bool consistent(const NodeReport& r, bool uses_horizon) {
    if ((r.in_view & ~r.quarters) != 0 || (r.drawn & ~r.in_view) != 0) return false;
    if (r.ahead && r.drawn != 0) return false;
    if (!uses_horizon && r.resident && r.drawn != r.in_view) return false;
    switch (r.fate) {
        case NodeFate::drawn:
            return r.resident && r.drawn == r.quarters;
        case NodeFate::drawn_in_part:
            return r.resident && r.drawn != 0 && r.drawn != r.quarters;
        case NodeFate::stands_in:
            return r.resident && r.drawn != 0;
        case NodeFate::hidden:
            return uses_horizon && r.resident && r.drawn == 0 && r.in_view != 0;
        case NodeFate::hidden_missing:
            return uses_horizon && !r.resident && r.in_view != 0;
        case NodeFate::missing:
            return !r.resident && r.in_view != 0;
        default:
            return r.in_view == 0;
    }
}

struct Seen {
    std::size_t hidden = 0, assumed = 0, standing_in = 0, ahead = 0;
};

void check_report(const Scene& scene, const select::Selection& selection, Seen& seen) {
    std::vector<NodeReport> nodes;
    selection.report(nodes);
    Coverage coverage(scene);
    bool all_consistent = true;
    for (const NodeReport& report : nodes) {
        coverage.add(report);
        all_consistent = all_consistent && consistent(report, selection.uses_horizon());
        seen.hidden += report.fate == NodeFate::hidden;
        seen.assumed += report.fate == NodeFate::hidden_missing;
        seen.standing_in += report.fate == NodeFate::stands_in;
        seen.ahead += report.ahead;
    }
    CHECK(coverage.exact());
    CHECK(all_consistent);
    CHECK(drawn_quarters(scene, nodes) == drawn_quarters(selection.result()));
}

}  // namespace

TEST_CASE("reports tell of every place with data exactly once, and agree with what is drawn") {
    const auto criterion = select::make_criterion("screen_error").value();
    for (const HorizonMode mode : {HorizonMode::off, HorizonMode::boxes, HorizonMode::ridges}) {
        Seen seen;
        for (const Scene& scene : scenes()) {
            const SceneGround ground(scene);
            select::Selection selection(scene.info(), scene.records(), *criterion);
            Random random(3);
            for (int i = 0; i < 40; ++i) {
                const auto residency = i % 2 == 0 ? all_resident(scene) : random_residency(scene, random);
                const auto view = low_view(scene, random, mode);
                // Twice, so that the second run assumes what the first one found hidden.
                for (int run = 0; run < 2; ++run) {
                    selection.run(view, residency, &ground);
                    check_report(scene, selection, seen);
                }
                auto anywhere = random_view(scene, random);
                anywhere.horizon = mode;
                selection.run(anywhere, residency, &ground);
                check_report(scene, selection, seen);
            }
        }
        // Or it would have proved little.
        CHECK((seen.hidden > 0) == (mode != HorizonMode::off));
        CHECK((seen.assumed > 0) == (mode != HorizonMode::off));
        CHECK(seen.standing_in > 0);
        CHECK(seen.ahead > 0);
    }
}

TEST_CASE("an azimuth falls in the slice and column in which its places lie, and slopes are theirs") {
    Random random(4);
    for (int i = 0; i < 20000; ++i) {
        const double turn = uniform(random, 0.0, 6.3), azimuth = uniform(random, -12.0, 12.0);
        const glm::dvec2 heading(std::sin(turn), std::cos(turn));
        const auto place = select::column_place(Angle::from_radians(azimuth));
        const select::SliceView slice(heading, place.slice);
        const double away_m = uniform(random, 1.0, 1e5), height_m = uniform(random, -1e3, 1e3);
        const glm::dvec2 at = away_m * glm::dvec2(std::sin(turn + azimuth), std::cos(turn + azimuth));
        REQUIRE(slice.z(at) > 0.0);
        const auto column = static_cast<double>(slice.place(static_cast<float>(slice.x(at) / slice.z(at))));
        // To the rounding of floats, which may carry it over a border.
        CHECK(column > place.column - 0.01);
        CHECK(column < place.column + 1.01);
        const double value = height_m / slice.z(at);
        CHECK(value * place.slope_per_value == doctest::Approx(height_m / away_m));
    }
}

TEST_CASE("a profile is what the columns say; where no slice was looked at, it says so") {
    const auto criterion = select::make_criterion("screen_error").value();
    const Scene& scene = scenes().front();
    const SceneGround ground(scene);
    select::Selection selection(scene.info(), scene.records(), *criterion);
    Random random(5);
    const auto residency = all_resident(scene);
    std::array<float, 2048> slopes;
    const Angle half_turn = Angle::from_degrees(180.0);
    int used = 0;
    for (int i = 0; i < 20; ++i) {
        selection.run(low_view(scene, random, HorizonMode::ridges), residency, &ground);
        if (!selection.uses_horizon()) continue;
        ++used;
        select::horizon_profile(selection, half_turn * -1.0, half_turn, slopes);
        float highest = -std::numeric_limits<float>::infinity();
        std::size_t looked_at = 0;
        for (const float slope : slopes) {
            if (slope == select::kNotLookedAt) continue;
            ++looked_at;
            highest = std::max(highest, slope);
        }
        std::size_t pictured = 0;
        float greatest = -std::numeric_limits<float>::infinity();
        for (int slice = 0; slice < select::SliceView::kSlices; ++slice) {
            const auto columns = selection.horizon_columns(slice);
            pictured += !columns.empty();
            for (const float value : columns) greatest = std::max(greatest, value);
        }
        CHECK(looked_at == pictured * slopes.size() / select::SliceView::kSlices);
        CHECK(pictured < select::SliceView::kSlices);
        CHECK(highest <= std::max(greatest, 0.0f));
        CHECK(highest > -std::numeric_limits<float>::infinity());
    }
    CHECK(used > 10);
    selection.run(low_view(scene, random, HorizonMode::off), residency, &ground);
    select::horizon_profile(selection, half_turn * -1.0, half_turn, slopes);
    CHECK(std::ranges::all_of(slopes, [](float slope) { return slope == select::kNotLookedAt; }));
}

}  // namespace ridgeline::test
