// Which renderers leave holes in a surface without any, by culling what their rasteriser turns round.
#include <doctest/doctest.h>

#include <optional>
#include <random>
#include <string_view>
#include <vector>

#include "ridgeline/gl/buffer.h"
#include "ridgeline/gl/framebuffer.h"
#include "ridgeline/gl/program.h"
#include "ridgeline/gl/screenshot.h"
#include "ridgeline/gl/vertex_array.h"
#include "ridgeline/shaders/shader_source.h"
#include "support/gl_context.h"

namespace ridgeline::gl {
namespace {

constexpr int kSide_px = 64;
constexpr int kQuads = 4 * kSide_px;

// Faces that run counter-clockwise, by the state or by dropping the others' fragments.
enum class Culling { by_state, by_fragment };

std::optional<std::string_view> shader_of_test(std::string_view path) {
    if (path == "sheet.vert")
        return R"(#version 450 core
layout(location = 0) uniform int quads;
layout(std430, binding = 0) readonly buffer Places { vec2 places[]; };
void main() {
    // Two triangles a quad, counter-clockwise while the lattice is even.
    const ivec2 corners[6] = ivec2[](ivec2(0, 0), ivec2(1, 0), ivec2(1, 1), ivec2(0, 0), ivec2(1, 1), ivec2(0, 1));
    ivec2 at = ivec2(gl_VertexID / 6 % quads, gl_VertexID / 6 / quads) + corners[gl_VertexID % 6];
    gl_Position = vec4(places[at.y * (quads + 1) + at.x], 0.5, 1.0);
})";
    if (path == "sheet.frag")
        return R"(#version 450 core
layout(location = 0) out vec4 color;
layout(location = 1) uniform int by_fragment;
void main() {
    if (by_fragment != 0 && !gl_FrontFacing) discard;
    color = vec4(1.0);
})";
    return shaders::shader_source(path);
}

// A lattice finer than pixels, its border far out of the picture, its inner places moved by more than their
// distance: folds and slivers, and over every place one face to the front more than to the back.
std::vector<glm::vec2> crumpled_sheet(std::mt19937& random) {
    constexpr float kFarOut = 3.0f;
    std::uniform_real_distribution<float> moved(-1.2f, 1.2f);
    std::vector<glm::vec2> places;
    for (int y = 0; y <= kQuads; ++y)
        for (int x = 0; x <= kQuads; ++x) {
            const bool border = x == 0 || y == 0 || x == kQuads || y == kQuads;
            const glm::vec2 by = border ? glm::vec2(0.0f) : glm::vec2(moved(random), moved(random));
            places.push_back(((glm::vec2(x, y) + by) * (2.0f / kQuads) - 1.0f) * (border ? kFarOut : 1.0f));
        }
    return places;
}

int count_holes(const Program& program, const RenderTarget& target, Culling culling) {
    target.framebuffer.bind();
    glClearColor(0.0f, 0.0f, 0.0f, 0.0f);
    glClear(GL_COLOR_BUFFER_BIT);
    glDisable(GL_DEPTH_TEST);
    if (culling == Culling::by_fragment) glDisable(GL_CULL_FACE);
    program.use();
    program.set(0, kQuads);
    program.set(1, culling == Culling::by_fragment ? 1 : 0);
    glDrawArrays(GL_TRIANGLES, 0, 6 * kQuads * kQuads);
    glEnable(GL_CULL_FACE);
    const Image image = read_image(target.framebuffer);
    int holes = 0;
    for (std::size_t i = 0; i < image.rgb.size(); i += 3) holes += image.rgb[i] == std::byte{0};
    return holes;
}

TEST_CASE(
    "a crumpled sheet has no hole with both faces; with one, only where facing is decided before snapping") {
    test::GlContext gl;
    if (!gl) return;
    set_frame_conventions();
    const auto program = Program::create({.stages = {"sheet.vert", "sheet.frag"}}, shader_of_test);
    REQUIRE_MESSAGE(program.ok(), (program ? "" : program.error().message));
    const auto target = RenderTarget::create({.size_px = {kSide_px, kSide_px}});
    REQUIRE(target);
    const VertexArray nothing = VertexArray::create();
    nothing.bind();
    std::mt19937 random(1);
    int holes = 0;
    for (int round = 0; round < 20; ++round) {
        const auto places = crumpled_sheet(random);
        const auto bytes = std::as_bytes(std::span(places));
        const auto buffer = Buffer::create({.size_bytes = bytes.size()}, bytes);
        REQUIRE(buffer);
        buffer->bind_base(GL_SHADER_STORAGE_BUFFER, 0);
        holes += count_holes(*program, *target, Culling::by_state);
        CHECK(count_holes(*program, *target, Culling::by_fragment) == 0);
    }
    MESSAGE("holes, culled by state: ", holes);
    CHECK((holes == 0 || query_capabilities().culls_before_snapping));
}

}  // namespace
}  // namespace ridgeline::gl
