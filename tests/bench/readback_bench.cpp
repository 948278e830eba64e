// What reading the ground back costs: the pass over a picture's depth, by how many pixels it looks at, and
// taking the result in. The picture is a plain seen from 200 m above it, level, half of it sky. Prints a
// table; docs/scheduling.md says what it was where.
//
//   bench_readback [WIDTH HEIGHT]
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <vector>

#include "ridgeline/gl/capabilities.h"
#include "ridgeline/platform/context.h"
#include "ridgeline/render/frame_uniforms.h"
#include "ridgeline/render/ground_readback.h"

namespace {

using namespace ridgeline;
using Clock = std::chrono::steady_clock;

constexpr double kAbove_m = 200.0;

template <class T>
T must(Result<T> result) {
    if (!result) std::fprintf(stderr, "%s\n", result.error().message.c_str()), std::exit(1);
    return std::move(result).value();
}

double milliseconds(Clock::duration time) { return std::chrono::duration<double, std::milli>(time).count(); }

double median(std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                     values.end());
    return values[values.size() / 2];
}

// A plain under a level camera: near / distance ahead.
gl::Texture2D plain_depth(const platform::Camera& camera) {
    const glm::ivec2 size = camera.lens.size_px;
    const double tangent = platform::half_tangents(camera.lens).y;
    std::vector<float> depth(static_cast<std::size_t>(size.x) * size.y, 0.0f);
    for (int y = 0; y < size.y / 2; ++y) {
        const double down = tangent * (1.0 - 2.0 * (y + 0.5) / size.y);
        std::fill_n(depth.begin() + static_cast<std::ptrdiff_t>(y) * size.x, size.x,
                    static_cast<float>(camera.lens.near_m * down / kAbove_m));
    }
    auto texture = must(gl::Texture2D::create({.format = GL_DEPTH_COMPONENT32F, .size_px = size}));
    texture.upload({.size_px = size}, {.format = GL_DEPTH_COMPONENT, .type = GL_FLOAT},
                   std::as_bytes(std::span(depth)));
    return texture;
}

gl::Buffer bind_uniforms(const platform::Camera& camera) {
    io::TerrainInfo info;
    info.width = info.height = 2;
    render::FrameView view;
    view.camera = camera;
    const auto uniforms = render::frame_uniforms(view, info);
    auto buffer = must(gl::Buffer::create({.size_bytes = sizeof uniforms}, gl::bytes_of(uniforms)));
    buffer.bind_base(GL_UNIFORM_BUFFER, shaders::kFrameUniformsBinding);
    return buffer;
}

void measure(const gl::Texture2D& depth, const platform::Camera& camera, const glm::ivec2& step_px) {
    constexpr int kWarmUp = 5, kRuns = 60;
    const select::GroundLattice lattice(select::GroundRectangle{{-2e5, -2e5}, {2e5, 2e5}});
    auto reader = must(render::GroundReader::create(lattice, {step_px}));
    std::vector<double> pass_ms, poll_ms;
    for (int i = 0; i < kWarmUp + kRuns; ++i) {
        glFinish();
        const auto start = Clock::now();
        reader.read(depth, {.camera = &camera, .sight = {.eye_m = camera.pose.eye_m}});
        glFinish();
        const auto done = Clock::now();
        reader.poll();
        const auto polled = Clock::now();
        if (i < kWarmUp) continue;
        pass_ms.push_back(milliseconds(done - start));
        poll_ms.push_back(milliseconds(polled - done));
    }
    const auto& counters = reader.counters();
    std::printf("%4d x %d  %9.3f %9.3f  %7llu\n", step_px.x, step_px.y, median(pass_ms), median(poll_ms),
                static_cast<unsigned long long>(counters.stalls));
}

}  // namespace

int main(int argc, char** argv) {
    platform::Camera camera;
    if (argc == 3) camera.lens.size_px = {std::atoi(argv[1]), std::atoi(argv[2])};
    camera.pose.eye_m = {0.0, 0.0, kAbove_m};
    const auto context = must(platform::open_headless({.size_px = {64, 64}}));
    if (const auto loaded = gl::load(context->gl_loader()); !loaded)
        return std::fprintf(stderr, "%s\n", loaded.error().message.c_str()), 1;
    const auto depth = plain_depth(camera);
    const auto uniforms = bind_uniforms(camera);
    std::printf("%s, %d x %d\nevery px    pass ms   poll ms   stalls\n",
                reinterpret_cast<const char*>(glGetString(GL_RENDERER)), camera.lens.size_px.x,
                camera.lens.size_px.y);
    for (const glm::ivec2 step_px : {glm::ivec2(8, 4), glm::ivec2(4, 2), glm::ivec2(2, 1), glm::ivec2(1, 1)})
        measure(depth, camera, step_px);
    return 0;
}
