#include "ridgeline/gl/framebuffer.h"

#include <vector>

#include "ridgeline/gl/debug_output.h"

namespace ridgeline::gl {

namespace {

bool is_depth(GLenum format) {
    return format == GL_DEPTH_COMPONENT16 || format == GL_DEPTH_COMPONENT24 ||
           format == GL_DEPTH_COMPONENT32 || format == GL_DEPTH_COMPONENT32F;
}

void attach_colors(GLuint id, std::span<const Texture2D* const> colors) {
    std::vector<GLenum> drawn;
    for (const Texture2D* color : colors) {
        const GLenum attachment = GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(drawn.size());
        glNamedFramebufferTexture(id, attachment, color->id(), 0);
        drawn.push_back(attachment);
    }
    if (drawn.empty()) drawn.push_back(GL_NONE);
    glNamedFramebufferDrawBuffers(id, static_cast<GLsizei>(drawn.size()), drawn.data());
    glNamedFramebufferReadBuffer(id, drawn.front());
}

}  // namespace

Result<Framebuffer> Framebuffer::create(const Attachments& attachments) {
    RIDGELINE_ASSERT_ROLE(render);
    RIDGELINE_CHECK(!attachments.colors.empty() || attachments.depth != nullptr);
    GLuint id = 0;
    glCreateFramebuffers(1, &id);
    Framebuffer framebuffer;
    framebuffer.object_ = Object<Traits>(id);
    attach_colors(id, attachments.colors);
    if (attachments.depth != nullptr)
        glNamedFramebufferTexture(id, GL_DEPTH_ATTACHMENT, attachments.depth->id(), 0);
    const Texture2D* sized = attachments.colors.empty() ? attachments.depth : attachments.colors.front();
    framebuffer.size_px_ = sized->size_px();
    return finish(std::move(framebuffer), attachments.label);
}

Result<Framebuffer> Framebuffer::create_layer(const Texture2DArray& texture, int layer,
                                              const std::string& label) {
    RIDGELINE_ASSERT_ROLE(render);
    GLuint id = 0;
    glCreateFramebuffers(1, &id);
    Framebuffer framebuffer;
    framebuffer.object_ = Object<Traits>(id);
    framebuffer.size_px_ = texture.size_px();
    const bool depth = is_depth(texture.options().format);
    glNamedFramebufferTextureLayer(id, depth ? GL_DEPTH_ATTACHMENT : GL_COLOR_ATTACHMENT0, texture.id(), 0,
                                   layer);
    glNamedFramebufferDrawBuffer(id, depth ? GL_NONE : GL_COLOR_ATTACHMENT0);
    glNamedFramebufferReadBuffer(id, depth ? GL_NONE : GL_COLOR_ATTACHMENT0);
    return finish(std::move(framebuffer), label);
}

Result<Framebuffer> Framebuffer::finish(Framebuffer framebuffer, const std::string& label) {
    set_label(GL_FRAMEBUFFER, framebuffer.id(), label);
    const GLenum status = glCheckNamedFramebufferStatus(framebuffer.id(), GL_DRAW_FRAMEBUFFER);
    if (status == GL_FRAMEBUFFER_COMPLETE) return framebuffer;
    return Error{label + ": the GPU driver cannot draw to this framebuffer (status " +
                 std::to_string(status) + ")"};
}

void Framebuffer::bind() const {
    glBindFramebuffer(GL_FRAMEBUFFER, id());
    glViewport(0, 0, size_px_.x, size_px_.y);
}

Result<RenderTarget> RenderTarget::create(const RenderTargetOptions& options) {
    auto color = Texture2D::create(
        {.format = options.color_format, .size_px = options.size_px, .label = options.label + " color"});
    if (!color) return color.error();
    auto depth = Texture2D::create(
        {.format = options.depth_format, .size_px = options.size_px, .label = options.label + " depth"});
    if (!depth) return depth.error();
    const Texture2D* colors[] = {&*color};
    auto framebuffer = Framebuffer::create({.colors = colors, .depth = &*depth, .label = options.label});
    if (!framebuffer) return framebuffer.error();
    return RenderTarget{std::move(*color), std::move(*depth), std::move(*framebuffer)};
}

void set_frame_conventions() {
    RIDGELINE_ASSERT_ROLE(render);
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glClearDepth(0.0);
    glDepthFunc(GL_GREATER);
    glEnable(GL_DEPTH_TEST);
    glFrontFace(GL_CCW);
    glEnable(GL_CULL_FACE);
    // The picture must not depend on the driver's taste.
    glDisable(GL_DITHER);
}

void blit_to_window(const Framebuffer& source, const glm::ivec2& window_size_px) {
    RIDGELINE_ASSERT_ROLE(render);
    const glm::ivec2 size = glm::min(source.size_px(), window_size_px);
    glBlitNamedFramebuffer(source.id(), 0, 0, 0, size.x, size.y, 0, 0, size.x, size.y, GL_COLOR_BUFFER_BIT,
                           GL_NEAREST);
}

}  // namespace ridgeline::gl
