// Vertex arrays: how vertex buffers feed a program's inputs. Move-only; render thread only.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "ridgeline/gl/buffer.h"
#include "ridgeline/gl/object.h"

namespace ridgeline::gl {

enum class AttributeKind { floating, normalized, integer };

struct VertexAttribute {
    GLuint location = 0;
    GLuint binding = 0;
    int components = 4;
    GLenum type = GL_FLOAT;
    AttributeKind kind = AttributeKind::floating;
    GLuint offset_bytes = 0;
};

class VertexArray {
  public:
    VertexArray() = default;
    // Without attributes: for vertices made in the shader.
    static VertexArray create(std::span<const VertexAttribute> attributes = {},
                              const std::string& label = {});

    bool empty() const { return object_.empty(); }
    GLuint id() const { return object_.id(); }
    void set_vertex_buffer(GLuint binding, const Buffer& buffer, std::uint64_t offset_bytes,
                           int stride_bytes);
    // 1: one step per instance; 0: one per vertex.
    void set_divisor(GLuint binding, GLuint divisor) { glVertexArrayBindingDivisor(id(), binding, divisor); }
    void set_index_buffer(const Buffer& buffer) { glVertexArrayElementBuffer(id(), buffer.id()); }
    void bind() const { glBindVertexArray(id()); }

  private:
    struct Traits {
        static void destroy(GLuint id) { glDeleteVertexArrays(1, &id); }
    };
    Object<Traits> object_;
};

}  // namespace ridgeline::gl
