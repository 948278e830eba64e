// What GL has to say, in the log: errors as errors, warnings as warnings, chatter as debug.
#pragma once

#include <cstdint>
#include <string>

#include <glad/gl.h>

namespace ridgeline::gl {

// Once per context, on the render thread.
void enable_debug_output();

// GL errors reported since the program started; tests assert that it does not grow. Any thread.
std::uint64_t debug_error_count();

// Names an object in GL's messages; nothing for an empty label.
void set_label(GLenum kind, GLuint id, const std::string& label);

// Groups the commands given during its life in GL debuggers and profiles.
class DebugGroup {
  public:
    explicit DebugGroup(const char* name) { glPushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 0, -1, name); }
    ~DebugGroup() { glPopDebugGroup(); }
    DebugGroup(const DebugGroup&) = delete;
    DebugGroup& operator=(const DebugGroup&) = delete;
};

}  // namespace ridgeline::gl
