#include "ridgeline/gl/fence.h"

#include "ridgeline/base/thread_role.h"

namespace ridgeline::gl {

Fence Fence::insert() {
    RIDGELINE_ASSERT_ROLE(render);
    return Fence(glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0));
}

Fence::~Fence() {
    if (sync_ != nullptr) glDeleteSync(sync_);
}

bool Fence::passed() const {
    if (sync_ == nullptr) return true;
    RIDGELINE_ASSERT_ROLE(render);
    const GLenum state = glClientWaitSync(sync_, 0, 0);
    return state == GL_ALREADY_SIGNALED || state == GL_CONDITION_SATISFIED;
}

bool Fence::wait(std::chrono::nanoseconds limit) const {
    if (sync_ == nullptr) return true;
    RIDGELINE_ASSERT_ROLE(render);
    const GLenum state =
        glClientWaitSync(sync_, GL_SYNC_FLUSH_COMMANDS_BIT, static_cast<GLuint64>(limit.count()));
    return state == GL_ALREADY_SIGNALED || state == GL_CONDITION_SATISFIED;
}

}  // namespace ridgeline::gl
