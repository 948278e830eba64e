// How many rays a second: casts and lines of sight over a store given as argument, beside the same rays marched
// in steps of half a spacing, as is often done, and how many of those end elsewhere. Rays begin at random over the
// whole terrain, or all at one place, as a sensor's do. Prints a table; docs/benchmarks.md says what it was where.
//
//   bench_ray DIR.terrain [LEVELS]      LEVELS: of made ground below it, a hundredth of the rays
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "ridgeline/io/store.h"
#include "ridgeline/select/surface_query.h"

namespace {

using namespace ridgeline;
using Random = std::mt19937_64;

double uniform(Random& random, double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
}

struct Ray {
    glm::dvec3 origin_m{0.0}, direction{0.0};
    double reach_m = 0.0;
};

// Over a place with ground, so many metres.
glm::dvec3 over_ground(select::SurfaceQuery& surface, const io::TerrainInfo& info, double above_m,
                       Random& random) {
    while (true) {
        const double column = uniform(random, 0.0, static_cast<double>(info.width - 1));
        const double row = uniform(random, 0.0, static_cast<double>(info.height - 1));
        const auto height = surface.height_at(column, row);
        if (height.ok() && height->kind == select::SurfaceHeight::Kind::ground)
            return {info.world(column, row), height->height_m + above_m};
    }
}

Ray looking(const glm::dvec3& origin_m, double least_pitch, double most_pitch, double reach_m,
            Random& random) {
    const double heading = uniform(random, 0.0, 2.0 * std::numbers::pi);
    const double pitch = uniform(random, least_pitch, most_pitch);
    return {origin_m,
            {std::sin(heading) * std::cos(pitch), std::cos(heading) * std::cos(pitch), std::sin(pitch)},
            reach_m};
}

struct Kind {
    const char* name;
    double above_m, least_pitch, most_pitch;
    bool one_place;
};
constexpr double kReach_m = 30'000.0;
constexpr Kind kKinds[] = {{"2 m over the ground, level", 2.0, -0.1, 0.1, false},
                           {"2000 m over it, down", 2000.0, -1.5, -0.3, false},
                           {"2 m, all from one place", 2.0, -0.1, 0.1, true},
                           {"2000 m, all from one place", 2000.0, -1.5, -0.3, true}};

std::vector<Ray> rays_of(const Kind& kind, const io::Store& store, int levels, int count) {
    Random random(5);
    select::SurfaceQuery surface(store, {.detail_levels = levels});
    std::vector<Ray> rays;
    glm::dvec3 origin_m(0.0);
    for (int i = 0; i < count; ++i) {
        if (i == 0 || !kind.one_place) origin_m = over_ground(surface, store.info(), kind.above_m, random);
        rays.push_back(looking(origin_m, kind.least_pitch, kind.most_pitch, kReach_m, random));
    }
    return rays;
}

double marched_m(select::SurfaceQuery& surface, const Ray& ray, double step_m) {
    for (double t = 0.0; t <= ray.reach_m; t += step_m) {
        const glm::dvec3 place = ray.origin_m + t * ray.direction;
        const auto height = surface.height(place.x, place.y);
        if (!height || height->kind == select::SurfaceHeight::Kind::outside) break;
        if (height->kind == select::SurfaceHeight::Kind::ground && place.z < height->height_m) return t;
    }
    return -1.0;
}

// Percent of the rays whose march ends elsewhere than with the step in which they meet the ground.
double missed_share(select::SurfaceQuery& surface, const std::vector<Ray>& rays, std::size_t count,
                    double step_m) {
    std::size_t missed = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const auto hit = surface.ray_cast(rays[i].origin_m, rays[i].direction, rays[i].reach_m);
        if (hit->hit && std::abs(marched_m(surface, rays[i], step_m) - hit->distance_m) > 1.001 * step_m)
            ++missed;
    }
    return 100.0 * static_cast<double>(missed) / static_cast<double>(count);
}

struct Rate {
    double per_second = 0.0, met_share = 0.0;
};

Rate measure(const std::vector<Ray>& rays, std::size_t count, const std::function<bool(const Ray&)>& meets) {
    std::size_t met = 0;
    const auto from = std::chrono::steady_clock::now();
    for (std::size_t i = 0; i < count; ++i) met += meets(rays[i]) ? 1 : 0;
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - from;
    return {static_cast<double>(count) / took.count(), static_cast<double>(met) / static_cast<double>(count)};
}

void measure_kind(const io::Store& store, int levels, const Kind& kind) {
    const std::size_t count = levels > 0 ? 1'000 : 100'000, marches = count / 100;
    const auto rays = rays_of(kind, store, levels, static_cast<int>(count));
    select::SurfaceQuery surface(store, {.detail_levels = levels});
    const auto casts = measure(rays, count, [&](const Ray& ray) {
        return surface.ray_cast(ray.origin_m, ray.direction, ray.reach_m)->hit;
    });
    const auto sights = measure(rays, count, [&](const Ray& ray) {
        return !surface.line_of_sight(ray.origin_m, ray.origin_m + ray.reach_m * ray.direction)->clear;
    });
    const double step_m =
        std::ldexp(0.5 * std::min(store.info().spacing_x_m, store.info().spacing_y_m), -levels);
    const auto steps =
        measure(rays, marches, [&](const Ray& ray) { return marched_m(surface, ray, step_m) >= 0.0; });
    std::printf("%-27s %9.0f %9.0f %9.0f %7.1f x %7.1f %% %9.1f %%\n", kind.name, casts.per_second,
                sights.per_second, steps.per_second, casts.per_second / steps.per_second,
                100.0 * casts.met_share, missed_share(surface, rays, marches, step_m));
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2 || argc > 3) return std::fprintf(stderr, "usage: bench_ray DIR.terrain [LEVELS]\n"), 2;
    const int levels = argc == 3 ? std::atoi(argv[2]) : 0;
    const auto store = io::Store::open_terrain(argv[1]);
    if (!store) return std::fprintf(stderr, "%s\n", store.error().message.c_str()), 1;
    std::printf("%-27s %9s %9s %9s %9s %9s %11s\n", "rays/s, reach 30 km", "cast", "sight", "steps", "faster",
                "casts met", "steps miss");
    for (const Kind& kind : kKinds) measure_kind(*store, levels, kind);
    return 0;
}
