// Constrained normal cones: against angles worked out in double, and on grounds whose shape is known.
#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <random>

#include "ridgeline/build/error_code.h"
#include "ridgeline/build/vertex_metric.h"

using namespace ridgeline;
using namespace ridgeline::build;

namespace {

io::TerrainInfo frame(double spacing_x_m, double spacing_y_m, double quantum_m) {
    io::TerrainInfo info;
    info.spacing_x_m = spacing_x_m;
    info.spacing_y_m = spacing_y_m;
    info.quantum_m = quantum_m;
    return info;
}

// Nine samples about a vertex, row by row from the north-west.
using Around = std::array<std::int32_t, 9>;

// Samples of a ground given in metres east and south of the vertex.
Around sampled(const io::TerrainInfo& info, double step,
               const std::function<double(double east, double south)>& height_m) {
    Around around{};
    for (int i = 0; i < 9; ++i) {
        const int east = i % 3 - 1, south = i / 3 - 1;
        around[static_cast<std::size_t>(i)] = static_cast<std::int32_t>(std::lround(
            height_m(east * step * info.spacing_x_m, south * step * info.spacing_y_m) / info.quantum_m));
    }
    return around;
}

// Faces in quarter order: north-west, north-east, south-west, south-east.
template <class Make>
auto faces_of(const Around& around, Make&& make) {
    const auto at = [&](int corner) {
        const auto i = static_cast<std::size_t>(corner);
        return make(around[i], around[i + 1], around[i + 3], around[i + 4]);
    };
    return std::array{at(0), at(1), at(3), at(4)};
}

double chord(const io::TerrainInfo& info, int scale, const Around& around) {
    const VertexMetric metric(Metric::cone, info);
    const auto f = faces_of(around, [&](auto nw, auto ne, auto sw, auto se) {
        return face_of(nw, ne, sw, se, metric.cones(scale));
    });
    return std::sqrt(static_cast<double>(squared_chord(f[0], f[1], f[2], f[3])));
}

// The half angle of the unconstrained cone as the paper writes it, z up; a face's normal is that of its
// diagonals.
double half_angle(const io::TerrainInfo& info, double step, const Around& around) {
    const double x = step * info.spacing_x_m, y = step * info.spacing_y_m;
    const auto normals = faces_of(around, [&](auto nw, auto ne, auto sw, auto se) {
        return glm::normalize(glm::cross(glm::dvec3(x, y, info.quantum_m * (ne - sw)),
                                         glm::dvec3(-x, y, info.quantum_m * (nw - se))));
    });
    glm::dvec3 least = normals[0], greatest = normals[0];
    for (const glm::dvec3& n : normals) {
        least = glm::min(least, n);
        greatest = glm::max(greatest, n);
    }
    const glm::dvec3 axis = glm::normalize(least + greatest);
    double cosine = 1.0;
    for (const glm::dvec3& n : normals) cosine = std::min(cosine, glm::dot(n, axis));
    return std::acos(std::min(cosine, 1.0));
}

const std::vector<io::TerrainInfo> kFrames = {frame(20.0, 20.0, 1.0), frame(20.14, 27.25, 0.01),
                                              frame(30.0, 10.0, 0.125)};
constexpr int kDirections = 16;

// Calls visit(info, height made of a profile across a line in every direction).
template <class Visit>
void for_each_direction(Visit&& visit) {
    for (const io::TerrainInfo& info : kFrames)
        for (int i = 0; i < kDirections; ++i) {
            const double angle = 2.0 * 3.14159265358979 * i / kDirections;
            visit(info, std::cos(angle), std::sin(angle));
        }
}

}  // namespace

TEST_CASE("cones: the chord is that of the paper's angle, or none in a hollow") {
    std::mt19937 random(1);
    int hollows = 0;
    for (const io::TerrainInfo& info : kFrames)
        for (int i = 0; i < 3000; ++i) {
            const int scale = static_cast<int>(random() % 10);
            const double step = std::ldexp(1.0, scale);
            const auto range = static_cast<std::uint32_t>(1 + (random() % 100) * step / info.quantum_m / 5.0);
            Around around{};
            for (std::int32_t& quanta : around) quanta = static_cast<std::int32_t>(random() % range);
            // Hollows are rare among random samples: every fourth ground gets a bowl beneath.
            if (i % 4 == 0)
                for (int j = 0; j < 9; ++j)
                    around[static_cast<std::size_t>(j)] +=
                        static_cast<std::int32_t>(range) * (std::abs(j % 3 - 1) + std::abs(j / 3 - 1));
            const double found = chord(info, scale, around);
            hollows += found == 0.0;
            if (found == 0.0) continue;
            CHECK(found ==
                  doctest::Approx(2.0 * std::sin(0.5 * half_angle(info, step, around))).epsilon(1e-4));
        }
    CHECK(hollows > 500);
    CHECK(hollows < 4500);
}

TEST_CASE("cones: none on planes, on valley floors and in bowls of any direction and slope") {
    for_each_direction([](const io::TerrainInfo& info, double east, double south) {
        const auto expect_none = [&](const std::function<double(double, double)>& height) {
            // Heights that quanta hold exactly enough; rounding would bend a plane.
            const io::TerrainInfo fine = frame(info.spacing_x_m, info.spacing_y_m, 1e-5);
            for (const int scale : {0, 3}) {
                const double found = chord(fine, scale, sampled(fine, std::ldexp(1.0, scale), height));
                CHECK(found < 2e-6);
            }
        };
        expect_none([&](double x, double y) { return 0.7 * (x * east + y * south); });
        expect_none([&](double x, double y) { return std::abs(x * east + y * south); });
        expect_none([&](double x, double y) {
            return 0.8 * std::abs(x * east + y * south) + 0.3 * (x * south - y * east);
        });
        expect_none(
            [&](double x, double y) { return 0.01 * (x * x + y * y) + 0.2 * (x * east + y * south); });
    });
}

TEST_CASE("cones: ridges, steps of ridges, peaks and passes of any direction have one") {
    for_each_direction([](const io::TerrainInfo& info, double east, double south) {
        const auto expect_some = [&](const std::function<double(double, double)>& height) {
            for (const int scale : {0, 3})
                CHECK(chord(info, scale, sampled(info, std::ldexp(1.0, scale), height)) > 0.02);
        };
        expect_some([&](double x, double y) { return -0.5 * std::abs(x * east + y * south); });
        expect_some([&](double x, double y) {
            return -0.5 * std::abs(x * east + y * south) + 0.5 * (x * south - y * east);
        });
        expect_some([](double x, double y) { return -0.3 * std::sqrt(x * x + y * y); });
        expect_some([&](double x, double y) {
            const double along = x * south - y * east, across = x * east + y * south;
            return 0.4 * (std::abs(along) - std::abs(across));
        });
    });
}

TEST_CASE("cones: a ridge of a known slope turns by that slope's angle") {
    const io::TerrainInfo info = frame(20.0, 20.0, 0.001);
    for (const double slope : {0.05, 0.5, 2.0}) {
        const double expected = 2.0 * std::sin(0.5 * std::atan(slope));
        const auto across_x = sampled(info, 1.0, [&](double x, double) { return -slope * std::abs(x); });
        const auto across_y = sampled(info, 1.0, [&](double, double y) { return -slope * std::abs(y); });
        CHECK(chord(info, 0, across_x) == doctest::Approx(expected).epsilon(1e-3));
        CHECK(chord(info, 0, across_y) == doctest::Approx(expected).epsilon(1e-3));
    }
}

TEST_CASE("error codes of squares: monotone, and a code's bound holds what has it") {
    std::uint8_t last = 0;
    for (double doubled = 0.0; doubled < 1e9; doubled = doubled * 1.003 + 0.001) {
        const std::uint8_t code = error_code_of_square(static_cast<float>(doubled * doubled));
        CHECK(code >= last);
        last = code;
        CHECK(2.0 * largest_error_of_square(code) >= doubled * (1.0 - 1e-6));
        if (code > 0)
            CHECK(2.0 * largest_error_of_square(static_cast<std::uint8_t>(code - 1)) <=
                  doubled * (1.0 + 1e-6));
    }
    CHECK(last > 200);
}
