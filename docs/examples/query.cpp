// Heights, a ray and a line of sight on a terrain store, without a window and without OpenGL.
//
//   query DIR.terrain
//
// Stands in the middle of the terrain, two metres over its ground, and looks about.
#include <cmath>
#include <cstdio>
#include <numbers>

#include "ridgeline/io/store.h"
#include "ridgeline/select/surface_query.h"

namespace {

using ridgeline::Error;
using ridgeline::Result;
using ridgeline::io::Store;
using ridgeline::select::SurfaceQuery;

constexpr double kEyeHeight_m = 2.0;
constexpr double kReach_m = 100'000.0;

// Every question reads tiles, and reading can fail: answers are Results, nothing throws.
Result<glm::dvec3> ground_at(SurfaceQuery& surface, double east_m, double north_m) {
    const auto height = surface.height(east_m, north_m);
    if (!height) return height.error();
    if (height->kind != ridgeline::select::SurfaceHeight::Kind::ground)
        return Error{"there is no ground in the middle of this terrain"};
    return glm::dvec3(east_m, north_m, height->height_m);
}

Result<void> look_about(SurfaceQuery& surface, const glm::dvec3& eye_m) {
    for (int heading_deg = 0; heading_deg < 360; heading_deg += 45) {
        const double heading = heading_deg * std::numbers::pi / 180.0;
        const glm::dvec3 direction(std::sin(heading), std::cos(heading), -0.02);
        const auto hit = surface.ray_cast(eye_m, direction, kReach_m);
        if (!hit) return hit.error();
        if (hit->hit)
            std::printf("heading %3d: ground at %.3f m, height %.3f m\n", heading_deg, hit->distance_m,
                        hit->point_m.z);
        else
            std::printf("heading %3d: no ground\n", heading_deg);
    }
    return {};
}

Result<void> answer(const char* directory) {
    const auto store = Store::open_terrain(directory);
    if (!store) return store.error();
    const auto& info = store->info();
    SurfaceQuery surface(*store);

    const double east_m = 0.5 * (info.min_east_m() + info.max_east_m());
    const double north_m = 0.5 * (info.min_north_m() + info.max_north_m());
    const auto ground = ground_at(surface, east_m, north_m);
    if (!ground) return ground.error();
    std::printf("height at %.3f,%.3f: %.3f m\n", east_m, north_m, ground->z);

    const glm::dvec3 eye_m = *ground + glm::dvec3(0.0, 0.0, kEyeHeight_m);
    RIDGELINE_TRY(look_about(surface, eye_m));

    const glm::dvec3 corner_m(info.max_east_m(), info.max_north_m(), info.max_height_m + 1.0);
    const auto sight = surface.line_of_sight(eye_m, corner_m);
    if (!sight) return sight.error();
    if (sight->clear)
        std::printf("north-eastern corner, over the highest ground: in sight\n");
    else
        std::printf("north-eastern corner, over the highest ground: hidden, by ground at %.3f m\n",
                    sight->hidden_by.distance_m);
    return {};
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) return std::fprintf(stderr, "usage: query DIR.terrain\n"), 2;
    if (const auto answered = answer(argv[1]); !answered)
        return std::fprintf(stderr, "query: error: %s\n", answered.error().message.c_str()), 1;
    return 0;
}
