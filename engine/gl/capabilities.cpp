#include "ridgeline/gl/capabilities.h"

#include <algorithm>
#include <initializer_list>
#include <string_view>

#include "ridgeline/base/thread_role.h"

namespace ridgeline::gl {

namespace {

std::string text_of(GLenum name) {
    const GLubyte* text = glGetString(name);
    return text != nullptr ? reinterpret_cast<const char*>(text) : "";
}

int integer_of(GLenum name) {
    GLint value = 0;
    glGetIntegerv(name, &value);
    return value;
}

bool names_one_of(std::string_view renderer, std::initializer_list<std::string_view> names) {
    return std::ranges::any_of(
        names, [&](std::string_view name) { return renderer.find(name) != std::string_view::npos; });
}

bool is_software(std::string_view renderer) {
    return names_one_of(renderer, {"llvmpipe", "softpipe", "swrast", "SwiftShader", "Software Rasterizer"});
}

bool uses_draw_module(std::string_view renderer) { return names_one_of(renderer, {"llvmpipe", "softpipe"}); }

}  // namespace

Result<void> load(GLADloadfunc loader) {
    RIDGELINE_ASSERT_ROLE(render);
    const int version = gladLoadGL(loader);
#ifdef GLAD_OPTION_GL_DEBUG
    // A loader made with brackets about every call begins with them in use: call_clock.h.
    gladUninstallGLDebug();
#endif
    if (version == 0) return Error{"OpenGL: no functions could be loaded: is a context current?"};
    if (version < GLAD_MAKE_VERSION(4, 5))
        return Error{"OpenGL: version 4.5 is needed, this driver has " + text_of(GL_VERSION) + " (" +
                     text_of(GL_RENDERER) + ")"};
    return {};
}

Capabilities query_capabilities() {
    RIDGELINE_ASSERT_ROLE(render);
    Capabilities found;
    found.vendor = text_of(GL_VENDOR);
    found.renderer = text_of(GL_RENDERER);
    found.version = text_of(GL_VERSION);
    found.software = is_software(found.renderer);
    found.culls_before_snapping = uses_draw_module(found.renderer);
    found.s3tc = GLAD_GL_EXT_texture_compression_s3tc != 0 && GLAD_GL_EXT_texture_sRGB != 0;
    if (GLAD_GL_ARB_texture_filter_anisotropic)
        glGetFloatv(GL_MAX_TEXTURE_MAX_ANISOTROPY, &found.max_anisotropy);
    found.max_texture_size_px = integer_of(GL_MAX_TEXTURE_SIZE);
    found.max_texture_layers = integer_of(GL_MAX_ARRAY_TEXTURE_LAYERS);
    GLint64 block_bytes = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &block_bytes);
    found.max_storage_block_bytes = static_cast<std::uint64_t>(block_bytes);
    glGetQueryiv(GL_TIMESTAMP, GL_QUERY_COUNTER_BITS, &found.timestamp_bits);
    return found;
}

}  // namespace ridgeline::gl
