// Framebuffers, and the render target that a frame is drawn into. Move-only; render thread only.
//
// Conventions of the whole program, set by set_frame_conventions(): depth runs from 1 near to 0 far
// (reverse-Z, GL_ZERO_TO_ONE, tested with GL_GREATER), front faces wind counter-clockwise.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <span>
#include <string>

#include "ridgeline/base/result.h"
#include "ridgeline/gl/object.h"
#include "ridgeline/gl/texture.h"

namespace ridgeline::gl {

class Framebuffer {
  public:
    Framebuffer() = default;

    struct Attachments {
        std::span<const Texture2D* const> colors{};  // may be empty
        const Texture2D* depth = nullptr;
        std::string label{};
    };
    // The textures must outlive it. Fails when the combination cannot be drawn to.
    static Result<Framebuffer> create(const Attachments& attachments);
    // One layer of an array as depth (shadow maps) or colour.
    static Result<Framebuffer> create_layer(const Texture2DArray& texture, int layer,
                                            const std::string& label);

    bool empty() const { return object_.empty(); }
    GLuint id() const { return object_.id(); }
    // For drawing, with the viewport over all of it.
    void bind() const;
    glm::ivec2 size_px() const { return size_px_; }

  private:
    struct Traits {
        static void destroy(GLuint id) { glDeleteFramebuffers(1, &id); }
    };
    static Result<Framebuffer> finish(Framebuffer framebuffer, const std::string& label);
    Object<Traits> object_;
    glm::ivec2 size_px_{0};
};

struct RenderTargetOptions {
    glm::ivec2 size_px{1024, 768};
    GLenum color_format = GL_RGBA8;
    GLenum depth_format = GL_DEPTH_COMPONENT32F;
    std::string label = "frame";
};

// Colour and depth textures with the framebuffer over them.
struct RenderTarget {
    Texture2D color;
    Texture2D depth;
    Framebuffer framebuffer;

    static Result<RenderTarget> create(const RenderTargetOptions& options);
};

// Sets GL's state to the program's conventions; once per context, after load().
void set_frame_conventions();

// Copies the colour to the window's framebuffer, pixel by pixel.
void blit_to_window(const Framebuffer& source, const glm::ivec2& window_size_px);

}  // namespace ridgeline::gl
