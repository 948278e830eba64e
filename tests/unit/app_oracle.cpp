// The visibility oracle against single rays and all triangles.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "ridgeline/app/bench/visibility_oracle.h"
#include "ridgeline/select/drawn_surface.h"
#include "unit/select_scene.h"

namespace ridgeline::test {
namespace {

using app::JudgedQuarter;
using app::LevelView;
using app::Sight;
using app::VisibilityOracle;
using select::DrawEntry;

constexpr int kSlices = 512;

// A frame with everything there, seen by a level camera that stands over its ground.
struct Frame {
    Frame(const Scene& scene, Random& random)
        : residency(all_resident(scene)),
          criterion(select::make_criterion("screen_error").value()),
          selection(scene.info(), scene.records(), *criterion) {
        const auto column = uniform(random, 0.02, 0.98) * static_cast<double>(scene.info().width - 1);
        const auto row = uniform(random, 0.02, 0.98) * static_cast<double>(scene.info().height - 1);
        camera.eye_m = {scene.info().world(column, row), scene.info().min_height_m};
        const double heading = uniform(random, 0.0, 6.3);
        view = {{std::sin(heading), std::cos(heading)},
                {uniform(random, 0.4, 1.4), uniform(random, 0.2, 1.0)}};
        camera.forward = {view.heading, 0.0};
        camera.right = {view.heading.y, -view.heading.x, 0.0};
        camera.height_px = static_cast<int>(camera.width_px * view.half_tangents.y / view.half_tangents.x);
        view.half_tangents.y = view.half_tangents.x * camera.height_px / camera.width_px;
        camera.horizontal_field = Angle::from_radians(2.0 * std::atan(view.half_tangents.x));
        options.pixel_error_px = std::exp(uniform(random, 0.0, 3.0));
        stand_on(scene, std::exp(uniform(random, 0.5, 4.5)));
    }

    void stand_on(const Scene& scene, double above_m) {
        const SceneGround ground(scene);
        for (int i = 0; i < 4; ++i) {
            selection.run(select::make_view(camera, options), residency);
            const auto about = selection.ground_about(residency, ground, -above_m);
            over_ground = about.complete;
            if (about.highest_m <= -above_m) return;
            camera.eye_m.z += about.highest_m + above_m;
        }
    }

    const select::EyeFrame& eye() const { return selection.result().eye; }
    std::span<const DrawEntry> draws() const { return selection.result().draws; }

    std::vector<io::NodeResidency> residency;
    std::unique_ptr<select::Criterion> criterion;
    select::Selection selection;
    select::Camera camera;
    select::ViewOptions options;
    LevelView view;
    bool over_ground = false;
};

// All triangles of a frame, and which quarter is whose.
class Triangles {
  public:
    Triangles(const Scene& scene, const Frame& frame) : view_(frame.view) {
        for (const DrawEntry& entry : frame.draws())
            for (int q = 0; q < io::kQuarters; ++q) {
                const io::ChunkView& chunk = scene.chunk(entry.index);
                for (const io::IndexRange& range : select::quarter_ranges(chunk.ranges(), entry, q))
                    for (std::uint32_t i = 0; i < range.count; i += 3)
                        add(chunk, frame, entry, q, range.first + i);
            }
    }

    struct Hit {
        const DrawEntry* entry = nullptr;
        int quarter = 0;
    };
    // The first that a ray meets, as tangents across and up; whichever side it meets.
    std::optional<Hit> first_hit(const glm::dvec2& ray) const {
        const glm::dvec2& ahead = view_.heading;
        const glm::dvec3 along(ahead + ray.x * glm::dvec2(ahead.y, -ahead.x), ray.y);
        double nearest = std::numeric_limits<double>::infinity();
        std::optional<Hit> hit;
        for (const Triangle& t : triangles_) {
            const double away = distance(t, along);
            if (away >= nearest) continue;
            nearest = away;
            hit = t.whose;
        }
        return hit;
    }

  private:
    struct Triangle {
        glm::dvec3 a, ab, ac;
        Hit whose;
    };

    void add(const io::ChunkView& chunk, const Frame& frame, const DrawEntry& entry, int quarter,
             std::uint32_t first) {
        glm::dvec3 p[3];
        for (std::uint32_t i = 0; i < 3; ++i)
            p[i] = glm::dvec3(select::drawn_vertex(frame.eye(), entry.origin, entry.morph,
                                                   chunk.vertices()[chunk.indices()[first + i]])
                                  .position_m);
        triangles_.push_back({p[0], p[1] - p[0], p[2] - p[0], {&entry, quarter}});
    }

    // In lengths of `along`; infinite for a miss.
    static double distance(const Triangle& t, const glm::dvec3& along) {
        constexpr double kMiss = std::numeric_limits<double>::infinity(), kOnEdge = 1e-9;
        const glm::dvec3 p = glm::cross(along, t.ac);
        const double determinant = glm::dot(t.ab, p);
        if (determinant == 0.0) return kMiss;
        const double u = glm::dot(-t.a, p) / determinant;
        if (u < -kOnEdge || u > 1.0 + kOnEdge) return kMiss;
        const glm::dvec3 q = glm::cross(-t.a, t.ab);
        const double v = glm::dot(along, q) / determinant;
        if (v < -kOnEdge || u + v > 1.0 + kOnEdge) return kMiss;
        const double away = glm::dot(t.ac, q) / determinant;
        return away > 0.0 ? away : kMiss;
    }

    LevelView view_;
    std::vector<Triangle> triangles_;
};

Sight sight_of(std::span<const JudgedQuarter> judged, const Triangles::Hit& hit) {
    for (const JudgedQuarter& quarter : judged)
        if (quarter.entry == hit.entry && quarter.quarter == hit.quarter) return quarter.sight;
    return Sight::outside;
}

struct Findings {
    int rays = 0;
    int unforeseen = 0;  // hits of what is said to be hidden
    int mistaken = 0;    // rays that meet something else than said
    int seen = 0, hidden = 0, unknown = 0;
};

void compare(const Triangles& triangles, std::span<const JudgedQuarter> judged, const LevelView& view,
             Random& random, Findings& findings) {
    for (int i = 0; i < 150; ++i) {
        const double across = (whole(random, 0, kSlices - 1) + 0.5) / kSlices * 2.0 - 1.0;
        const glm::dvec2 ray = glm::dvec2(across, uniform(random, -1.0, 1.0)) * view.half_tangents;
        const auto hit = triangles.first_hit(ray);
        if (!hit) continue;
        const Sight sight = sight_of(judged, *hit);
        ++findings.rays;
        findings.unforeseen += sight != Sight::seen && sight != Sight::unknown;
    }
    for (const JudgedQuarter& quarter : judged) {
        findings.seen += quarter.sight == Sight::seen;
        findings.hidden += quarter.sight == Sight::hidden;
        findings.unknown += quarter.sight == Sight::unknown;
        if (quarter.sight != Sight::seen || quarter.clearance < 1e-6) continue;
        const auto hit = triangles.first_hit(quarter.ray);
        findings.mistaken += !hit || hit->entry != quarter.entry || hit->quarter != quarter.quarter;
    }
}

enum class Sabotage { none, lose_nearest };

Findings compare_frames(const SceneShape& shape, int frames, Sabotage sabotage) {
    const Scene scene(shape);
    const SceneGround ground(scene);
    VisibilityOracle oracle(scene.grid(), scene.records(), ground, {.slices = kSlices});
    Random random(shape.seed);
    Findings findings;
    for (int i = 0; i < frames; ++i) {
        const Frame frame(scene, random);
        if (!frame.over_ground) continue;
        const Triangles triangles(scene, frame);
        auto draws = frame.draws();
        if (sabotage == Sabotage::lose_nearest) draws = draws.subspan(draws.size() / 4);
        compare(triangles, oracle.judge(frame.eye(), draws, frame.view), frame.view, random, findings);
    }
    return findings;
}

}  // namespace

TEST_CASE("what a ray meets is seen, and what is seen a ray meets; on ground without holes all is known") {
    for (const SceneShape& shape :
         {SceneShape{257, 257, 32, 1},
          {129, 129, 32, 2},
          {513, 257, 32, 3},
          SceneShape{.width = 257, .height = 257, .seed = 4, .vertices_per_node = 30}}) {
        const Findings findings = compare_frames(shape, 25, Sabotage::none);
        CHECK(findings.unforeseen == 0);
        CHECK(findings.mistaken == 0);
        CHECK(findings.unknown == 0);
        CHECK(findings.rays > 1000);
        CHECK(findings.seen > 100);
        CHECK(findings.hidden > 100);
    }
}

TEST_CASE("through holes in the ground: what a ray meets is seen or unknown, what is seen a ray meets") {
    for (const SceneShape& shape : {SceneShape{300, 180, 32, 5, 0.1},
                                    {257, 513, 32, 6, 0.3},
                                    SceneShape{.width = 300, .height = 290, .seed = 7, .voids = 12}}) {
        const Findings findings = compare_frames(shape, 30, Sabotage::none);
        CHECK(findings.unforeseen == 0);
        CHECK(findings.mistaken == 0);
        CHECK(findings.unknown > 10);
        CHECK(findings.seen > 100);
        CHECK(findings.hidden > 50);
    }
}

TEST_CASE("an oracle that misses the ground in front is found out") {
    const Findings findings = compare_frames({257, 257, 32, 1}, 25, Sabotage::lose_nearest);
    CHECK(findings.unforeseen + findings.mistaken > 100);
}

}  // namespace ridgeline::test
