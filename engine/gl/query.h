// One GPU query (occlusion, pipeline statistics, timestamp). Move-only; render thread only.
#pragma once

#include <cstdint>
#include <optional>

#include "ridgeline/gl/object.h"

namespace ridgeline::gl {

class Query {
  public:
    Query() = default;
    static Query create(GLenum target);

    bool empty() const { return object_.empty(); }
    GLuint id() const { return object_.id(); }
    void begin() const { glBeginQuery(target_, id()); }
    void end() const { glEndQuery(target_); }
    // target = GL_TIMESTAMP: the GPU's time when it gets here.
    void mark() const { glQueryCounter(id(), GL_TIMESTAMP); }
    // Nothing until the GPU has finished it; never waits.
    std::optional<std::uint64_t> result() const;

  private:
    struct Traits {
        static void destroy(GLuint id) { glDeleteQueries(1, &id); }
    };
    Object<Traits> object_;
    GLenum target_ = 0;
};

}  // namespace ridgeline::gl
