#include <doctest/doctest.h>

#include <array>
#include <cstdlib>

#include "ridgeline/base/whole_file.h"
#include "ridgeline/gl/program.h"
#include "ridgeline/gl/screenshot.h"
#include "ridgeline/gl/vertex_array.h"
#include "ridgeline/platform/camera.h"
#include "support/gl_context.h"

namespace ridgeline::gl {
namespace {

std::array<int, 3> pixel(const Image& image, int x, int y) {
    const auto at = static_cast<std::size_t>(y * image.size_px.x + x) * 3;
    return {std::to_integer<int>(image.rgb[at]), std::to_integer<int>(image.rgb[at + 1]),
            std::to_integer<int>(image.rgb[at + 2])};
}

ShaderLookup triangle_shaders() {
    return [](std::string_view path) -> std::optional<std::string_view> {
        if (path == "triangle.vert")
            return R"(#version 450 core
layout(location = 0) uniform mat4 clip_from_eye_world;
layout(location = 0) in vec3 from_eye;
layout(location = 1) in vec3 color;
layout(location = 0) out vec3 shade;
void main() {
    shade = color;
    gl_Position = clip_from_eye_world * vec4(from_eye, 1.0);
}
)";
        if (path == "triangle.frag")
            return R"(#version 450 core
layout(location = 0) in vec3 shade;
layout(location = 0) out vec4 fragment;
void main() { fragment = vec4(shade, 1.0); }
)";
        return std::nullopt;
    };
}

// A triangle a hundred metres ahead of an eye that looks east: red in the north (left), green in the south
// (right), blue up; kept for looking at where RIDGELINE_TEST_OUT names a folder.
TEST_CASE(
    "a triangle in the world is drawn where the camera sees it, and the picture's top row comes first") {
    test::GlContext gl;
    if (!gl) return;
    const auto program = Program::create({.stages = {"triangle.vert", "triangle.frag"}}, triangle_shaders());
    REQUIRE_MESSAGE(program.ok(), (program ? "" : program.error().message));
    const float vertices[] = {100, -60, -40, 0, 1, 0, 100, 0, 50, 0, 0, 1, 100, 60, -40, 1, 0, 0};
    const auto buffer =
        Buffer::create({.size_bytes = sizeof vertices, .label = "triangle"}, bytes_of(vertices));
    REQUIRE(buffer);
    const VertexAttribute attributes[] = {{.location = 0, .components = 3},
                                          {.location = 1, .components = 3, .offset_bytes = 12}};
    VertexArray array = VertexArray::create(attributes, "triangle");
    array.set_vertex_buffer(0, *buffer, 0, 24);
    const auto target = RenderTarget::create({.size_px = {333, 257}});
    REQUIRE(target);

    platform::Camera camera;
    camera.pose.heading = Angle::from_degrees(90.0);
    camera.lens.size_px = {333, 257};
    target->framebuffer.bind();
    glClearColor(0.2f, 0.2f, 0.2f, 1.0f);  // a whole step of 255: drivers round halves either way
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    program->use();
    program->set(0, glm::mat4(platform::clip_from_eye_world(camera)));
    array.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);

    const Image image = read_image(target->framebuffer);
    REQUIRE(image.size_px == glm::ivec2(333, 257));
    // Where the projection puts the corners: x = 166.5 - north * k, y = 128.5 - up * k, k = pixels per metre
    // there.
    const double k = platform::pixels_per_tangent(camera.lens) / 100.0;
    const auto top = pixel(image, 166, static_cast<int>(128.5 - 48.0 * k));
    CHECK(top[2] > 200);
    const auto left = pixel(image, static_cast<int>(166.5 - 57.0 * k), static_cast<int>(128.5 + 39.0 * k));
    CHECK(left[0] > 200);
    const auto right = pixel(image, static_cast<int>(166.5 + 57.0 * k), static_cast<int>(128.5 + 39.0 * k));
    CHECK(right[1] > 200);
    CHECK(pixel(image, 0, 0) == std::array{51, 51, 51});
    if (const char* folder = std::getenv("RIDGELINE_TEST_OUT"))
        CHECK(write_png(std::filesystem::path(folder) / "triangle.png", image));
}

TEST_CASE("a PNG holds the size it was given and is whole or not there") {
    Image image{{5, 3}, std::vector<std::byte>(45, std::byte{200})};
    const auto file = std::filesystem::temp_directory_path() / "ridgeline_png_test.png";
    REQUIRE(write_png(file, image));
    const auto text = read_text_file(file);
    std::filesystem::remove(file);
    REQUIRE(text);
    CHECK(text->substr(1, 3) == "PNG");
    CHECK(text->at(19) == 5);
    CHECK(text->at(23) == 3);
    CHECK(text->at(25) == 2);  // RGB
    const auto failed = write_png("/nowhere/at/all.png", image);
    REQUIRE_FALSE(failed);
    CHECK(failed.error().message.starts_with("/nowhere/at/all.png: "));
}

TEST_CASE("shrinking averages whole squares") {
    Image image{{5, 2}, std::vector<std::byte>(30)};
    for (std::size_t i = 0; i < 30; ++i) image.rgb[i] = static_cast<std::byte>(i * 4);
    const Image small = shrink(image, 2);
    CHECK(small.size_px == glm::ivec2(2, 1));
    // Pixels 0, 1 of both rows: red values 0, 12, 60, 72.
    CHECK(pixel(small, 0, 0) == std::array{36, 40, 44});
    CHECK(shrink(image, 1).rgb == image.rgb);
}

}  // namespace
}  // namespace ridgeline::gl
