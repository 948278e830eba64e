#include <doctest/doctest.h>

#include <cstring>
#include <map>

#include "ridgeline/gl/program.h"
#include "ridgeline/gl/screenshot.h"
#include "ridgeline/gl/vertex_array.h"
#include "ridgeline/shaders/shader_source.h"
#include "support/gl_context.h"

namespace ridgeline::gl {
namespace {

// The built-in shaders and, over them, what a test brings along.
ShaderLookup with(std::map<std::string, std::string, std::less<>> files) {
    return [files = std::move(files)](std::string_view path) -> std::optional<std::string_view> {
        const auto found = files.find(path);
        if (found == files.end()) return shaders::shader_source(path);
        return found->second;
    };
}

TEST_CASE("every pass that is built in compiles") {
    test::GlContext gl;
    if (!gl) return;
    for (const auto& file : shaders::shader_files()) {
        if (!file.path.starts_with("passes/")) continue;
        CAPTURE(file.path);
        const auto program = Program::create({.stages = {std::string(file.path)}});
        CHECK_MESSAGE(program.ok(), (program ? "" : program.error().message));
    }
}

TEST_CASE("the full-screen triangle covers every pixel once, at the depth it is given") {
    test::GlContext gl;
    if (!gl) return;
    const auto program = Program::create({.stages = {"passes/fullscreen.vert", "color.frag"}},
                                         with({{"color.frag", R"(#version 450 core
#include "lib/color.h"
layout(location = 0) out vec4 fragment;
layout(location = 1) uniform vec4 step_color;
void main() { fragment = step_color * linear_from_srgb(1.0f); }
)"}}));
    REQUIRE_MESSAGE(program.ok(), (program ? "" : program.error().message));
    const auto target = RenderTarget::create({.size_px = {37, 23}});
    REQUIRE(target);
    target->framebuffer.bind();
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE);
    program->use();
    program->set(0, 0.5f);
    program->set(1, glm::vec4(3.0f / 255.0f));
    const VertexArray nothing = VertexArray::create();
    nothing.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
    // Behind it and equally far, reverse-Z keeps what is there.
    program->set(0, 0.25f);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    program->set(0, 0.5f);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    const Image image = read_image(target->framebuffer);
    int wrong = 0;
    for (std::byte value : image.rgb) wrong += std::to_integer<int>(value) == 3 ? 0 : 1;
    CHECK(wrong == 0);
}

TEST_CASE("a compiler's complaint names the included file and its line") {
    test::GlContext gl;
    if (!gl) return;
    const auto lookup =
        with({{"broken.frag", "#version 450 core\n#include \"lib/broken.h\"\nvoid main() {}\n"},
              {"lib/broken.h", "#pragma once\n\nfloat f() { return unknown_name; }\n"}});
    const auto program = Program::create({.stages = {"broken.frag"}}, lookup);
    REQUIRE_FALSE(program);
    MESSAGE(program.error().message);
    CHECK(program.error().message.find("lib/broken.h:3") != std::string::npos);
    CHECK(program.error().message.find("unknown_name") != std::string::npos);
    CHECK(program.error().message.find('\n') == std::string::npos);
    // Mesa reports the failed compilation through debug output too.
    gl.expect_errors(debug_error_count() - gl.errors_before());
}

TEST_CASE("stages that do not fit together are an error that names them") {
    test::GlContext gl;
    if (!gl) return;
    const auto lookup = with({{"in.frag", R"(#version 450 core
layout(location = 3) in vec4 absent;
layout(location = 0) out vec4 fragment;
void main() { fragment = absent; }
)"}});
    const auto program = Program::create({.stages = {"passes/fullscreen.vert", "in.frag"}}, lookup);
    REQUIRE_FALSE(program);
    CHECK(program.error().message.find("passes/fullscreen.vert + in.frag") != std::string::npos);
    gl.expect_errors(debug_error_count() - gl.errors_before());
}

TEST_CASE("shared structs have the same layout in GLSL and C++") {
    test::GlContext gl;
    if (!gl) return;
    // One header for both languages: a struct of each kind of field that blocks may hold.
    const auto lookup = with({{"layout.comp", R"(#version 450 core
#include "shared/portable.h"
SHADER_BEGIN
struct Probe {
    mat4 matrix;
    ivec4 cell;
    vec2 pair;
    float scale;
    uint count;
};
SHADER_STRUCT_SIZE(Probe, 96)
SHADER_OFFSET(Probe, pair, 80)
SHADER_END
layout(local_size_x = 1) in;
layout(std140, binding = 0) uniform ProbeBlock { Probe probe; };
layout(std430, binding = 1) writeonly buffer Out { float values[]; };
void main() {
    values[0] = probe.matrix[3].y;
    values[1] = float(probe.cell.z);
    values[2] = probe.pair.y;
    values[3] = probe.scale;
    values[4] = float(probe.count);
}
)"}});
    const auto program = Program::create({.stages = {"layout.comp"}}, lookup);
    REQUIRE_MESSAGE(program.ok(), (program ? "" : program.error().message));
    struct Probe {
        glm::mat4 matrix{0.0f};
        glm::ivec4 cell{0};
        glm::vec2 pair{0.0f};
        float scale = 0.0f;
        std::uint32_t count = 0;
    } probe;
    static_assert(sizeof(Probe) == 96);
    probe.matrix[3].y = 1.5f;
    probe.cell.z = -7;
    probe.pair.y = 2.5f;
    probe.scale = 3.5f;
    probe.count = 9;
    const auto uniforms = Buffer::create({.size_bytes = sizeof(Probe), .label = "probe"}, bytes_of(probe));
    const auto values = Buffer::create({.size_bytes = 20, .use = BufferUse::readback, .label = "values"});
    REQUIRE((uniforms && values));
    uniforms->bind_base(GL_UNIFORM_BUFFER, 0);
    values->bind_base(GL_SHADER_STORAGE_BUFFER, 1);
    program->use();
    glDispatchCompute(1, 1, 1);
    glMemoryBarrier(GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
    glFinish();
    float found[5];
    std::memcpy(found, values->mapped().data(), sizeof found);
    CHECK(found[0] == 1.5f);
    CHECK(found[1] == -7.0f);
    CHECK(found[2] == 2.5f);
    CHECK(found[3] == 3.5f);
    CHECK(found[4] == 9.0f);
}

}  // namespace
}  // namespace ridgeline::gl
