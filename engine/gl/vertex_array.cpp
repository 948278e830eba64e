#include "ridgeline/gl/vertex_array.h"

#include "ridgeline/gl/debug_output.h"

namespace ridgeline::gl {

namespace {

void set_format(GLuint id, const VertexAttribute& attribute) {
    const auto& [location, binding, components, type, kind, offset] = attribute;
    glEnableVertexArrayAttrib(id, location);
    glVertexArrayAttribBinding(id, location, binding);
    if (kind == AttributeKind::integer)
        glVertexArrayAttribIFormat(id, location, components, type, offset);
    else
        glVertexArrayAttribFormat(id, location, components, type,
                                  kind == AttributeKind::normalized ? GL_TRUE : GL_FALSE, offset);
}

}  // namespace

VertexArray VertexArray::create(std::span<const VertexAttribute> attributes, const std::string& label) {
    RIDGELINE_ASSERT_ROLE(render);
    GLuint id = 0;
    glCreateVertexArrays(1, &id);
    VertexArray array;
    array.object_ = Object<Traits>(id);
    for (const auto& attribute : attributes) set_format(id, attribute);
    set_label(GL_VERTEX_ARRAY, id, label);
    return array;
}

void VertexArray::set_vertex_buffer(GLuint binding, const Buffer& buffer, std::uint64_t offset_bytes,
                                    int stride_bytes) {
    glVertexArrayVertexBuffer(id(), binding, buffer.id(), static_cast<GLintptr>(offset_bytes), stride_bytes);
}

}  // namespace ridgeline::gl
