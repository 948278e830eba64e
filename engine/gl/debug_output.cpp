#include "ridgeline/gl/debug_output.h"

#include <atomic>
#include <string>
#include <string_view>

#include "ridgeline/base/log.h"
#include "ridgeline/base/thread_role.h"

namespace ridgeline::gl {

namespace {

std::atomic<std::uint64_t> error_count{0};

LogLevel level_of(GLenum type, GLenum severity) {
    if (type == GL_DEBUG_TYPE_ERROR) return LogLevel::error;
    // Performance hints are of use to whoever develops; a user cannot act on them.
    if (type == GL_DEBUG_TYPE_PERFORMANCE || type == GL_DEBUG_TYPE_OTHER) return LogLevel::debug;
    switch (severity) {
        case GL_DEBUG_SEVERITY_HIGH:
            return LogLevel::warn;
        case GL_DEBUG_SEVERITY_MEDIUM:
            return LogLevel::info;
        case GL_DEBUG_SEVERITY_LOW:
            return LogLevel::debug;
        default:
            return LogLevel::trace;
    }
}

void GLAD_API_PTR on_message(GLenum, GLenum type, GLuint, GLenum severity, GLsizei length,
                             const GLchar* message, const void*) {
    if (type == GL_DEBUG_TYPE_PUSH_GROUP || type == GL_DEBUG_TYPE_POP_GROUP) return;
    if (type == GL_DEBUG_TYPE_ERROR) error_count.fetch_add(1, std::memory_order_relaxed);
    const LogLevel level = level_of(type, severity);
    if (!is_logged(level)) return;
    std::string_view text(message, static_cast<std::size_t>(length));
    while (!text.empty() && text.back() == '\n') text.remove_suffix(1);
    log_line(level, "OpenGL: " + std::string(text));
}

bool is_debug_context() {
    GLint flags = 0;
    glGetIntegerv(GL_CONTEXT_FLAGS, &flags);
    return (flags & GL_CONTEXT_FLAG_DEBUG_BIT) != 0;
}

}  // namespace

void enable_debug_output() {
    RIDGELINE_ASSERT_ROLE(render);
    glEnable(GL_DEBUG_OUTPUT);
    // In a debug context a breakpoint in the callback then stands in the call at fault.
    if (is_debug_context()) glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    glDebugMessageCallback(on_message, nullptr);
}

std::uint64_t debug_error_count() { return error_count.load(std::memory_order_relaxed); }

void set_label(GLenum kind, GLuint id, const std::string& label) {
    if (!label.empty()) glObjectLabel(kind, id, static_cast<GLsizei>(label.size()), label.data());
}

}  // namespace ridgeline::gl
