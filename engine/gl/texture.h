// Textures of immutable storage and the samplers that read them.
//
// Texels come from memory or, with a pixel-unpack buffer, from an offset into it (the staging ring).
// Move-only; render thread only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>

#include "ridgeline/base/result.h"
#include "ridgeline/gl/buffer.h"
#include "ridgeline/gl/object.h"

namespace ridgeline::gl {

struct TextureOptions {
    GLenum format = GL_RGBA8;  // sized or compressed internal format
    glm::ivec2 size_px{0};
    int levels = 1;
    int layers = 1;  // Texture2DArray only
    std::string label{};
};

// Where an upload goes: a rectangle of one mip level of one layer.
struct TextureRegion {
    int level = 0;
    int layer = 0;
    glm::ivec2 origin_px{0};
    glm::ivec2 size_px{0};
};

// How uploaded texels lie in memory: rows one after another, top of the region first as GL counts (y = 0).
struct TexelLayout {
    GLenum format = GL_RGBA;         // or the internal format, of compressed texels
    GLenum type = GL_UNSIGNED_BYTE;  // unused for compressed texels
    int row_length_px = 0;           // texels from row to row, 0: as wide as the region
};

namespace detail {

struct TextureTraits {
    static void destroy(GLuint id) { glDeleteTextures(1, &id); }
};

}  // namespace detail

// A 2D texture, or an array of them: one class per GL target would differ in three calls.
template <GLenum target>
class Texture {
  public:
    Texture() = default;
    // Fails when the GPU has not the memory.
    static Result<Texture> create(const TextureOptions& options);

    bool empty() const { return object_.empty(); }
    GLuint id() const { return object_.id(); }
    const TextureOptions& options() const { return options_; }
    glm::ivec2 size_px() const { return options_.size_px; }

    void upload(const TextureRegion& region, const TexelLayout& layout, std::span<const std::byte> texels);
    // From `source` at `offset_bytes`; the GPU reads it later: the bytes must stay until a fence after this
    // passes.
    void upload(const TextureRegion& region, const TexelLayout& layout, const Buffer& source,
                std::uint64_t offset_bytes);
    void generate_mipmaps() { glGenerateTextureMipmap(id()); }
    void bind(GLuint unit) const { glBindTextureUnit(unit, id()); }
    // For compute shaders; all layers of an array at once.
    void bind_image(GLuint unit, int level, GLenum access) const;

  private:
    Object<detail::TextureTraits> object_;
    TextureOptions options_;
};

using Texture2D = Texture<GL_TEXTURE_2D>;
using Texture2DArray = Texture<GL_TEXTURE_2D_ARRAY>;

struct SamplerOptions {
    GLenum min_filter = GL_LINEAR;
    GLenum mag_filter = GL_LINEAR;
    GLenum wrap = GL_CLAMP_TO_EDGE;
    float max_anisotropy = 1.0f;        // capped by what the GPU can
    GLenum compare_function = GL_NONE;  // shadow maps: GL_GEQUAL with reverse-Z
};

class Sampler {
  public:
    Sampler() = default;
    static Sampler create(const SamplerOptions& options);

    bool empty() const { return object_.empty(); }
    GLuint id() const { return object_.id(); }
    void bind(GLuint unit) const { glBindSampler(unit, id()); }

  private:
    struct Traits {
        static void destroy(GLuint id) { glDeleteSamplers(1, &id); }
    };
    Object<Traits> object_;
};

extern template class Texture<GL_TEXTURE_2D>;
extern template class Texture<GL_TEXTURE_2D_ARRAY>;

}  // namespace ridgeline::gl
