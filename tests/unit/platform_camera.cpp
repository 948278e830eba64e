#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "ridgeline/platform/camera.h"

namespace ridgeline::platform {
namespace {

constexpr double kTiny = 1e-9;

double length_of(const glm::dvec3& v) { return glm::length(v); }

class Random {
  public:
    double between(double least, double most) { return std::uniform_real_distribution(least, most)(engine_); }
    glm::dvec3 direction() {
        std::normal_distribution<double> normal;
        return glm::normalize(glm::dvec3(normal(engine_), normal(engine_), normal(engine_)));
    }
    Camera camera() {
        Camera camera;
        camera.pose = {direction() * 1e6, Angle::from_degrees(between(-180, 180)),
                       Angle::from_degrees(between(-89, 89))};
        camera.lens.horizontal_fov = Angle::from_degrees(between(20, 110));
        camera.lens.size_px = glm::ivec2(between(200, 2000), between(200, 1200));
        return camera;
    }

  private:
    std::mt19937_64 engine_{7};
};

bool holds(const Frustum& frustum, const glm::dvec3& point, double slack = 0.0) {
    for (const auto& plane : frustum.planes)
        if (glm::dot(plane.normal, point) + plane.offset < -slack) return false;
    return true;
}

TEST_CASE("heading turns clockwise from north and pitch up from level") {
    const auto looks = [](double heading_deg, double pitch_deg) {
        return forward({glm::dvec3(0.0), Angle::from_degrees(heading_deg), Angle::from_degrees(pitch_deg)});
    };
    CHECK(length_of(looks(0, 0) - glm::dvec3(0, 1, 0)) < kTiny);
    CHECK(length_of(looks(90, 0) - glm::dvec3(1, 0, 0)) < kTiny);
    CHECK(length_of(looks(180, 0) - glm::dvec3(0, -1, 0)) < kTiny);
    CHECK(length_of(looks(0, 90) - glm::dvec3(0, 0, 1)) < kTiny);
    CHECK(length_of(looks(90, -45) - glm::dvec3(std::sqrt(0.5), 0, -std::sqrt(0.5))) < kTiny);
}

TEST_CASE("the view's axes are right, up and backwards, for any direction") {
    Random random;
    for (int i = 0; i < 1000; ++i) {
        const Pose pose = random.camera().pose;
        const glm::dmat3 view = view_from_world(pose);
        CHECK(length_of(view * right(pose) - glm::dvec3(1, 0, 0)) < kTiny);
        CHECK(length_of(view * up(pose) - glm::dvec3(0, 1, 0)) < kTiny);
        CHECK(length_of(view * forward(pose) - glm::dvec3(0, 0, -1)) < kTiny);
        CHECK(up(pose).z >= 0.0);
        CHECK(glm::determinant(view) == doctest::Approx(1.0));
    }
}

TEST_CASE("looking_along gives back the pose whose forward it was given") {
    Random random;
    for (int i = 0; i < 1000; ++i) {
        const Pose pose = random.camera().pose;
        const Pose again = looking_along(pose.eye_m, forward(pose) * 3.0);
        CHECK(again.heading.radians() == doctest::Approx(pose.heading.radians()));
        CHECK(again.pitch.radians() == doctest::Approx(pose.pitch.radians()));
    }
}

TEST_CASE("the short way round is never more than half a turn") {
    Random random;
    for (int i = 0; i < 1000; ++i) {
        const Angle from = Angle::from_degrees(random.between(-1000, 1000));
        const Angle to = Angle::from_degrees(random.between(-1000, 1000));
        const double turn = shortest_turn(from, to).degrees();
        CHECK(std::abs(turn) <= 180.0 + kTiny);
        CHECK(std::abs(std::remainder(from.degrees() + turn - to.degrees(), 360.0)) < 1e-6);
    }
    CHECK(shortest_turn(Angle::from_degrees(350), Angle::from_degrees(10)).degrees() == doctest::Approx(20));
}

TEST_CASE("depth is 1 at the near plane and falls towards 0 with distance") {
    const Lens lens;
    const auto depth_at = [&](double distance_m) {
        const glm::dvec4 clip = clip_from_view(lens) * glm::dvec4(0, 0, -distance_m, 1);
        return clip.z / clip.w;
    };
    CHECK(depth_at(lens.near_m) == doctest::Approx(1.0));
    CHECK(depth_at(100.0) == doctest::Approx(lens.near_m / 100.0));
    CHECK(depth_at(1e12) > 0.0);
}

TEST_CASE("a lens' horizontal field spans the picture's width, and pixels are square") {
    const Lens lens{Angle::from_degrees(90), {800, 400}, 0.1};
    const glm::dvec4 corner = clip_from_view(lens) * glm::dvec4(10, 5, -10, 1);
    CHECK(corner.x / corner.w == doctest::Approx(1.0));
    CHECK(corner.y / corner.w == doctest::Approx(1.0));
    CHECK(pixels_per_tangent(lens) == doctest::Approx(400.0));
}

TEST_CASE("a point is in the frustum exactly if it lands in the clip volume") {
    Random random;
    int inside = 0;
    for (int i = 0; i < 20000; ++i) {
        const Camera camera = random.camera();
        const glm::dvec3 from_eye = random.direction() * random.between(0.05, 1000.0);
        const glm::dvec4 clip = clip_from_eye_world(camera) * glm::dvec4(from_eye, 1.0);
        const double least =
            std::min({clip.w - std::abs(clip.x), clip.w - std::abs(clip.y), clip.w - clip.z});
        // Within rounding of a plane either answer is right.
        if (std::abs(least) < 1e-6) continue;
        CHECK(holds(frustum(camera), camera.pose.eye_m + from_eye) == (least > 0.0));
        inside += least > 0.0 ? 1 : 0;
    }
    CHECK(inside > 1000);
}

TEST_CASE("a frustum with a margin holds whatever a turn by that angle about any axis can show") {
    Random random;
    int cut = 0;
    for (int i = 0; i < 20000; ++i) {
        const Camera camera = random.camera();
        const Angle margin = Angle::from_degrees(random.between(1, 50));
        const Frustum wide = frustum(camera, margin);
        const glm::dvec2 tangents = half_tangents(camera.lens);
        const glm::dvec3 seen(tangents.x * random.between(-1, 1), tangents.y * random.between(-1, 1), -1.0);
        const glm::dvec3 in_world = glm::transpose(view_from_world(camera.pose)) * glm::normalize(seen);
        const double turn = margin.radians() * random.between(0, 1);
        const glm::dmat3 rotation(glm::rotate(glm::dmat4(1.0), turn, random.direction()));
        CHECK(holds(wide, camera.pose.eye_m + rotation * in_world * 100.0, 1e-6));
        cut += holds(wide, camera.pose.eye_m - in_world * 100.0) ? 0 : 1;
    }
    // The margin must not be bought by holding everything.
    CHECK(cut > 5000);
}

}  // namespace
}  // namespace ridgeline::platform
