// Where shadow maps lie: over all that is seen, with room for the filter, and still while the camera moves.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <optional>
#include <random>

#include "ridgeline/render/shadow_cascades.h"
#include "ridgeline/shaders/lib/shadow.h"

using namespace ridgeline;
using namespace ridgeline::render;

namespace {

double uniform(std::mt19937& random, double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random);
}

ShadowView random_view(std::mt19937& random) {
    ShadowView view;
    view.spacing_m = std::exp(uniform(random, std::log(0.5), std::log(90.0)));
    const glm::dvec2 size =
        view.spacing_m * glm::dvec2(uniform(random, 200, 9000), uniform(random, 200, 9000));
    view.terrain_m.min = {uniform(random, 1e5, 9e5), uniform(random, 1e6, 9e6),
                          uniform(random, -400.0, 10.0)};
    view.terrain_m.max = view.terrain_m.min + glm::dvec3(size, uniform(random, 0.0, 5000.0));
    const glm::dvec3 place(uniform(random, -0.2, 1.2), uniform(random, -0.2, 1.2), uniform(random, 0.0, 3.0));
    view.camera.pose = {glm::mix(view.terrain_m.min, view.terrain_m.max, place),
                        Angle::from_degrees(uniform(random, -180.0, 180.0)),
                        Angle::from_degrees(uniform(random, -90.0, 30.0))};
    view.camera.lens.horizontal_fov = Angle::from_degrees(uniform(random, 20.0, 120.0));
    view.daylight = {Angle::from_degrees(uniform(random, 0.0, 360.0)),
                     Angle::from_degrees(std::exp(uniform(random, std::log(0.2), std::log(90.0))))};
    view.map_px = random() % 2 == 0 ? 512 : 2048;
    return view;
}

// A place of the terrain's box that the camera sees, relative to the eye.
glm::dvec3 seen_place(std::mt19937& random, const ShadowView& view) {
    const Frustum frustum = platform::frustum(view.camera);
    for (int i = 0; i < 2000; ++i) {
        const glm::dvec3 share(uniform(random, 0, 1), uniform(random, 0, 1), uniform(random, 0, 1));
        glm::dvec3 place = glm::mix(view.terrain_m.min, view.terrain_m.max, share);
        // Half of them near the eye, where the small rings are.
        if (i % 2 == 0)
            place = glm::clamp(glm::mix(view.camera.pose.eye_m, place, std::exp(uniform(random, -7.0, 0.0))),
                               view.terrain_m.min, view.terrain_m.max);
        if (contains(frustum, {place, place}) == Containment::inside) return place - view.camera.pose.eye_m;
    }
    return glm::dvec3(0.0);
}

std::size_t ring_at(const ShadowCascades& cascades, double distance_m) {
    std::size_t ring = 0;
    while (ring + 1 < ShadowCascades::kCount && distance_m >= cascades.rings[ring].end_m) ++ring;
    return ring;
}

// As passes/terrain.frag looks it up, at its farthest.
void check_lookup(const ShadowView& view, const ShadowCascades& cascades, std::size_t ring,
                  const glm::dvec3& place, const glm::dvec3& normal) {
    const ShadowCascade& map = cascades.rings[ring];
    const glm::vec2 tilt(glm::dot(normal, cascades.axes.across), glm::dot(normal, cascades.axes.along));
    const double offset_m = double{shaders::normal_offset_m(tilt, glm::vec2(map.texel_m))};
    const glm::dvec4 clip = map.map_from_eye * glm::dvec4(place + normal * offset_m, 1.0);
    const glm::dvec2 texels = (0.5 + 0.5 * glm::dvec2(clip)) * double(view.map_px);
    constexpr double kFilter_px = 2.5;
    CHECK(texels.x > kFilter_px);
    CHECK(texels.y > kFilter_px);
    CHECK(texels.x < view.map_px - kFilter_px);
    CHECK(texels.y < view.map_px - kFilter_px);
    CHECK(clip.z > 0.0);
    CHECK(clip.z < 1.0);
}

glm::dvec3 random_normal(std::mt19937& random) {
    const glm::dvec3 v(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, 0, 1));
    return glm::normalize(v + glm::dvec3(0.0, 0.0, 1e-6));
}

}  // namespace

TEST_CASE("Whatever is seen lies in its ring's map, with room for the filter") {
    std::mt19937 random(1);
    int looked_up = 0;
    for (int i = 0; i < 400; ++i) {
        const ShadowView view = random_view(random);
        const ShadowCascades cascades = shadow_cascades(view);
        REQUIRE(cascades.sun_is_up);
        for (int k = 0; k < 20; ++k) {
            const glm::dvec3 place = seen_place(random, view);
            if (place == glm::dvec3(0.0)) continue;
            const double distance_m = glm::length(place);
            const std::size_t ring = ring_at(cascades, distance_m);
            CAPTURE(i);
            CAPTURE(ring);
            check_lookup(view, cascades, ring, place, random_normal(random));
            if (distance_m > cascades.rings[ring].blend_m && ring + 1 < ShadowCascades::kCount)
                check_lookup(view, cascades, ring + 1, place, random_normal(random));
            ++looked_up;
        }
    }
    CHECK(looked_up > 3000);
}

TEST_CASE("Whatever stands between what is seen and the sun is within a map's depth") {
    std::mt19937 random(2);
    for (int i = 0; i < 400; ++i) {
        const ShadowView view = random_view(random);
        const ShadowCascades cascades = shadow_cascades(view);
        const glm::dvec3 share(uniform(random, 0, 1), uniform(random, 0, 1), uniform(random, 0, 1));
        const glm::dvec3 seen = seen_place(random, view);
        const glm::dvec3 caster =
            glm::mix(view.terrain_m.min, view.terrain_m.max, share) - view.camera.pose.eye_m;
        if (seen == glm::dvec3(0.0)) continue;
        const double before_m = glm::dot(cascades.axes.towards, caster - seen);
        const ShadowCascade& map = cascades.rings[ring_at(cascades, glm::length(seen))];
        const double depth = (map.map_from_eye * glm::dvec4(caster, 1.0)).z;
        CHECK(depth < 1.0);
        if (before_m >= 0.0) CHECK(depth > 0.0);
    }
}

TEST_CASE("Texels lie on a lattice that is fixed to the ground, and keep their size through a slow move") {
    std::mt19937 random(3);
    int frames = 0, steps = 0;
    for (int i = 0; i < 60; ++i) {
        ShadowView view = random_view(random);
        std::optional<ShadowCascades> before;
        const glm::dvec3 move =
            view.spacing_m *
            glm::dvec3(uniform(random, -0.3, 0.3), uniform(random, -0.3, 0.3), uniform(random, -0.03, 0.03));
        const glm::dvec3 anchor = view.terrain_m.min;
        for (int k = 0; k < 30; ++k) {
            view.camera.pose.eye_m += move;
            view.camera.pose.heading = view.camera.pose.heading + Angle::from_degrees(0.1);
            const ShadowCascades cascades = shadow_cascades(view);
            const glm::dvec3 eye = view.camera.pose.eye_m - anchor;
            for (std::size_t r = 0; r < ShadowCascades::kCount; ++r) {
                const ShadowCascade& map = cascades.rings[r];
                if (map.most_m.x < map.least_m.x) continue;
                const glm::dvec2 corner = map.least_m + glm::dvec2(glm::dot(cascades.axes.across, eye),
                                                                   glm::dot(cascades.axes.along, eye));
                const glm::dvec2 texels = corner / map.texel_m;
                CHECK(glm::length(texels - glm::round(texels)) < 1e-4);
                if (!before) continue;
                ++frames;
                steps += before->rings[r].texel_m != map.texel_m ? 1 : 0;
            }
            before = cascades;
        }
    }
    CHECK(steps < frames / 40);
    MESSAGE(steps, " changes of size in ", frames, " maps");
}

TEST_CASE("Maps lie where they lie whatever is drawn, and none under a sun that has set") {
    std::mt19937 random(4);
    ShadowView view = random_view(random);
    view.daylight.sun_elevation = Angle::from_degrees(0.0);
    CHECK_FALSE(shadow_cascades(view).sun_is_up);
    CHECK(sun_view(shadow_cascades(view), select::CasterSet::all).casters == select::CasterSet::none);
    view.daylight.sun_elevation = Angle::from_degrees(1.0);
    const ShadowCascades cascades = shadow_cascades(view);
    const select::SunView all = sun_view(cascades, select::CasterSet::all),
                          some = sun_view(cascades, select::CasterSet::pvs);
    CHECK(all.casters == select::CasterSet::all);
    CHECK(some.casters == select::CasterSet::pvs);
    for (std::size_t i = 1; i < some.reach_count; ++i) {
        CHECK(some.reaches[i].from_m > some.reaches[i - 1].from_m);
        CHECK(some.reaches[i].aside_m.x >= some.reaches[i - 1].aside_m.x);
    }
}

TEST_CASE("Four bilinear comparisons weigh as a tent over three by three does") {
    std::mt19937 random(5);
    for (int i = 0; i < 2000; ++i) {
        // What comparisons give at texels 0..15 of a small map.
        std::array<std::array<double, 16>, 16> lit{};
        for (auto& row : lit)
            for (double& value : row) value = random() % 2 == 0 ? 1.0 : 0.0;
        const auto bilinear = [&](double x, double y) {
            const double u = x - 0.5, v = y - 0.5;
            const auto column = static_cast<std::size_t>(std::floor(u)),
                       row = static_cast<std::size_t>(std::floor(v));
            const double s = u - std::floor(u), t = v - std::floor(v);
            return (1 - t) * ((1 - s) * lit[row][column] + s * lit[row][column + 1]) +
                   t * ((1 - s) * lit[row + 1][column] + s * lit[row + 1][column + 1]);
        };
        const glm::vec2 place(uniform(random, 5.0, 10.0), uniform(random, 5.0, 10.0));
        double tent = 0.0;
        constexpr double kWeights[3] = {0.25, 0.5, 0.25};
        for (int row = -1; row <= 1; ++row)
            for (int column = -1; column <= 1; ++column)
                tent += kWeights[row + 1] * kWeights[column + 1] *
                        bilinear(double{place.x} + column, double{place.y} + row);
        const shaders::ShadowTaps taps = shaders::shadow_taps(place);
        const auto at = [&](float x, float y) { return static_cast<float>(bilinear(double{x}, double{y})); };
        const glm::vec4 four(at(taps.x.x, taps.y.x), at(taps.x.y, taps.y.x), at(taps.x.x, taps.y.y),
                             at(taps.x.y, taps.y.y));
        CHECK(double{shaders::sunlit_share(four, taps)} == doctest::Approx(tent).epsilon(1e-4));
    }
}
