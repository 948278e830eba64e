#include <doctest/doctest.h>

#include "support/gl_context.h"

namespace ridgeline::gl {
namespace {

TEST_CASE("a headless context is OpenGL 4.5 core and says what it is") {
    test::GlContext gl;
    if (!gl) return;
    GLint profile = 0;
    glGetIntegerv(GL_CONTEXT_PROFILE_MASK, &profile);
    CHECK((profile & GL_CONTEXT_CORE_PROFILE_BIT) != 0);
    const Capabilities found = query_capabilities();
    MESSAGE(gl.context().description(), ": ", found.renderer, ", OpenGL ", found.version);
    CHECK_FALSE(found.renderer.empty());
    CHECK(found.max_texture_size_px >= 16384);
    CHECK(found.max_texture_layers >= 2048);
    CHECK(found.timestamp_bits > 0);
    CHECK(gl.context().glfw_window() == nullptr);
    CHECK(gl.context().size_px() == glm::ivec2(64, 64));
    gl.context().present();
}

TEST_CASE("two headless contexts keep their objects apart") {
    test::GlContext first;
    if (!first) return;
    {
        test::GlContext second;
        GLuint id = 0;
        glCreateBuffers(1, &id);
        CHECK(glIsBuffer(id) == GL_TRUE);
        first.context().make_current();
        CHECK(glIsBuffer(id) == GL_FALSE);
        second.context().make_current();
        glDeleteBuffers(1, &id);
    }
    first.context().make_current();
    CHECK(glGetError() == GL_NO_ERROR);
}

TEST_CASE("a headless context has no events") {
    test::GlContext gl;
    if (!gl) return;
    platform::Input input;
    input.wheel_steps = 3.0;
    gl.context().poll(input);
    CHECK(input.wheel_steps == 0.0);
    CHECK_FALSE(input.close_requested);
}

TEST_CASE("GL errors are counted") {
    test::GlContext gl;
    if (!gl) return;
    gl.expect_errors(1);
    const auto before = debug_error_count();
    glEnable(0xDEAD);
    CHECK(debug_error_count() == before + 1);
}

}  // namespace
}  // namespace ridgeline::gl
