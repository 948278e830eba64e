#include "ridgeline/gl/texture.h"

#include <algorithm>
#include <cmath>

#include "ridgeline/gl/debug_output.h"
#include "ridgeline/gl/memory_check.h"

namespace ridgeline::gl {

namespace {

bool is_compressed(GLenum format) {
    switch (format) {
        case GL_COMPRESSED_RGB_S3TC_DXT1_EXT:
        case GL_COMPRESSED_SRGB_S3TC_DXT1_EXT:
        case GL_COMPRESSED_SRGB_ALPHA_S3TC_DXT1_EXT:
        case GL_COMPRESSED_RED_RGTC1:
        case GL_COMPRESSED_SIGNED_RED_RGTC1:
        case GL_COMPRESSED_RG_RGTC2:
        case GL_COMPRESSED_SIGNED_RG_RGTC2:
            return true;
        default:
            return false;
    }
}

// Both kinds have blocks of 4x4 texels; two-channel ones take 16 bytes, the others 8.
GLsizei compressed_bytes(GLenum format, const glm::ivec2& size_px) {
    const bool two_channels = format == GL_COMPRESSED_RG_RGTC2 || format == GL_COMPRESSED_SIGNED_RG_RGTC2;
    return ((size_px.x + 3) / 4) * ((size_px.y + 3) / 4) * (two_channels ? 16 : 8);
}

// For messages alone: the sizes of the formats in use, 4 bytes for the rest.
std::uint64_t bytes_per_16_texels(GLenum format) {
    if (is_compressed(format)) return static_cast<std::uint64_t>(compressed_bytes(format, {4, 4}));
    switch (format) {
        case GL_R8:
        case GL_R8UI:
            return 16;
        case GL_R16:
        case GL_R16I:
        case GL_R16UI:
        case GL_R16F:
        case GL_RG8:
        case GL_RG8UI:
            return 32;
        case GL_RGBA16F:
        case GL_RG32F:
        case GL_RG32UI:
        case GL_RGBA16UI:
            return 128;
        case GL_RGBA32F:
        case GL_RGBA32UI:
        case GL_RGBA32I:
            return 256;
        default:
            return 64;
    }
}

std::uint64_t storage_bytes(const TextureOptions& options) {
    const std::uint64_t texels = static_cast<std::uint64_t>(options.size_px.x) *
                                 static_cast<std::uint64_t>(options.size_px.y) *
                                 static_cast<std::uint64_t>(options.layers);
    return texels * bytes_per_16_texels(options.format) / 16;
}

// Pixels for glTextureSubImage come from the bound unpack buffer, or from memory when none is bound.
void set_unpacking(const TexelLayout& layout, GLuint unpack_buffer) {
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, unpack_buffer);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, layout.row_length_px);
}

void sub_image_2d(GLuint id, const TextureRegion& region, const TexelLayout& layout, const void* texels) {
    const auto [x, y] = std::pair(region.origin_px.x, region.origin_px.y);
    if (is_compressed(layout.format))
        glCompressedTextureSubImage2D(id, region.level, x, y, region.size_px.x, region.size_px.y,
                                      layout.format, compressed_bytes(layout.format, region.size_px), texels);
    else
        glTextureSubImage2D(id, region.level, x, y, region.size_px.x, region.size_px.y, layout.format,
                            layout.type, texels);
}

void sub_image_array(GLuint id, const TextureRegion& region, const TexelLayout& layout, const void* texels) {
    const auto [x, y] = std::pair(region.origin_px.x, region.origin_px.y);
    if (is_compressed(layout.format))
        glCompressedTextureSubImage3D(id, region.level, x, y, region.layer, region.size_px.x,
                                      region.size_px.y, 1, layout.format,
                                      compressed_bytes(layout.format, region.size_px), texels);
    else
        glTextureSubImage3D(id, region.level, x, y, region.layer, region.size_px.x, region.size_px.y, 1,
                            layout.format, layout.type, texels);
}

template <GLenum target>
void sub_image(GLuint id, const TextureRegion& region, const TexelLayout& layout, const void* texels) {
    RIDGELINE_ASSERT_ROLE(render);
    if constexpr (target == GL_TEXTURE_2D)
        sub_image_2d(id, region, layout, texels);
    else
        sub_image_array(id, region, layout, texels);
}

}  // namespace

template <GLenum target>
Result<Texture<target>> Texture<target>::create(const TextureOptions& options) {
    RIDGELINE_ASSERT_ROLE(render);
    RIDGELINE_CHECK(options.size_px.x > 0 && options.size_px.y > 0 && options.levels > 0 &&
                    options.layers > 0);
    GLuint id = 0;
    glCreateTextures(target, 1, &id);
    Texture texture;
    texture.object_ = Object<detail::TextureTraits>(id);
    texture.options_ = options;
    const MemoryCheck memory;
    if constexpr (target == GL_TEXTURE_2D)
        glTextureStorage2D(id, options.levels, options.format, options.size_px.x, options.size_px.y);
    else
        glTextureStorage3D(id, options.levels, options.format, options.size_px.x, options.size_px.y,
                           options.layers);
    RIDGELINE_TRY(memory.finish(options.label, storage_bytes(options)));
    set_label(GL_TEXTURE, id, options.label);
    return texture;
}

template <GLenum target>
void Texture<target>::upload(const TextureRegion& region, const TexelLayout& layout,
                             std::span<const std::byte> texels) {
    set_unpacking(layout, 0);
    sub_image<target>(id(), region, layout, texels.data());
}

template <GLenum target>
void Texture<target>::upload(const TextureRegion& region, const TexelLayout& layout, const Buffer& source,
                             std::uint64_t offset_bytes) {
    set_unpacking(layout, source.id());
    // GL takes the offset into the bound buffer in the guise of a pointer.
    sub_image<target>(id(), region, layout, reinterpret_cast<const void*>(offset_bytes));
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
}

template <GLenum target>
void Texture<target>::bind_image(GLuint unit, int level, GLenum access) const {
    const GLboolean layered = target == GL_TEXTURE_2D ? GL_FALSE : GL_TRUE;
    glBindImageTexture(unit, id(), level, layered, 0, access, options_.format);
}

template class Texture<GL_TEXTURE_2D>;
template class Texture<GL_TEXTURE_2D_ARRAY>;

Sampler Sampler::create(const SamplerOptions& options) {
    RIDGELINE_ASSERT_ROLE(render);
    GLuint id = 0;
    glCreateSamplers(1, &id);
    Sampler sampler;
    sampler.object_ = Object<Traits>(id);
    const auto set = [id](GLenum name, GLenum value) {
        glSamplerParameteri(id, name, static_cast<GLint>(value));
    };
    set(GL_TEXTURE_MIN_FILTER, options.min_filter);
    set(GL_TEXTURE_MAG_FILTER, options.mag_filter);
    set(GL_TEXTURE_WRAP_S, options.wrap);
    set(GL_TEXTURE_WRAP_T, options.wrap);
    if (options.compare_function != GL_NONE) {
        set(GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
        set(GL_TEXTURE_COMPARE_FUNC, options.compare_function);
    }
    if (GLAD_GL_ARB_texture_filter_anisotropic && options.max_anisotropy > 1.0f) {
        GLfloat limit = 1.0f;
        glGetFloatv(GL_MAX_TEXTURE_MAX_ANISOTROPY, &limit);
        glSamplerParameterf(id, GL_TEXTURE_MAX_ANISOTROPY, std::min(options.max_anisotropy, limit));
    }
    return sampler;
}

}  // namespace ridgeline::gl
