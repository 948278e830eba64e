#include "ridgeline/gl/query.h"

namespace ridgeline::gl {

Query Query::create(GLenum target) {
    RIDGELINE_ASSERT_ROLE(render);
    GLuint id = 0;
    glCreateQueries(target, 1, &id);
    Query query;
    query.object_ = Object<Traits>(id);
    query.target_ = target;
    return query;
}

std::optional<std::uint64_t> Query::result() const {
    RIDGELINE_ASSERT_ROLE(render);
    GLuint available = GL_FALSE;
    glGetQueryObjectuiv(id(), GL_QUERY_RESULT_AVAILABLE, &available);
    if (available == GL_FALSE) return std::nullopt;
    GLuint64 value = 0;
    glGetQueryObjectui64v(id(), GL_QUERY_RESULT, &value);
    return value;
}

}  // namespace ridgeline::gl
