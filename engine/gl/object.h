// Ownership of one GL name: move-only, empty by default, deleted with its owner.
//
// Every GL class of this room holds one. Render thread only, and the context must still be current when the
// owner dies.
#pragma once

#include <glad/gl.h>

#include <utility>

#include "ridgeline/base/thread_role.h"

namespace ridgeline::gl {

// Traits::destroy(GLuint) deletes the name.
template <class Traits>
class Object {
  public:
    Object() = default;
    explicit Object(GLuint id) : id_(id) {}
    Object(Object&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
    Object& operator=(Object&& other) noexcept {
        std::swap(id_, other.id_);
        return *this;
    }
    ~Object() {
        if (id_ == 0) return;
        RIDGELINE_ASSERT_ROLE(render);
        Traits::destroy(id_);
    }

    bool empty() const { return id_ == 0; }
    GLuint id() const { return id_; }

  private:
    GLuint id_ = 0;
};

}  // namespace ridgeline::gl
