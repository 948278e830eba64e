// GPU programs from the shaders built into the executable. Move-only; render thread only.
//
// Stages come from the file endings: .vert, .frag, .geom, .tesc, .tese, .comp. Uniform locations and block
// bindings are explicit in our shaders (layout(location = …), layout(binding = …)), so there is nothing to
// look up.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "ridgeline/base/result.h"
#include "ridgeline/gl/object.h"
#include "ridgeline/gl/shader_source.h"

namespace ridgeline::gl {

struct ProgramOptions {
    std::vector<std::string> stages;  // paths from shaders/: "passes/terrain.vert", "passes/terrain.frag"
    std::vector<ShaderDefine> defines{};
};

class Program {
  public:
    Program() = default;
    // Errors hold the compiler's first lines with file and line.
    static Result<Program> create(const ProgramOptions& options);
    // The same with other sources than those built in; for tests.
    static Result<Program> create(const ProgramOptions& options, const ShaderLookup& lookup);

    bool empty() const { return object_.empty(); }
    GLuint id() const { return object_.id(); }
    void use() const { glUseProgram(id()); }

    void set(GLint location, int value) const { glProgramUniform1i(id(), location, value); }
    void set(GLint location, GLuint value) const { glProgramUniform1ui(id(), location, value); }
    void set(GLint location, float value) const { glProgramUniform1f(id(), location, value); }
    void set(GLint location, const glm::vec2& value) const {
        glProgramUniform2fv(id(), location, 1, &value.x);
    }
    void set(GLint location, const glm::vec3& value) const {
        glProgramUniform3fv(id(), location, 1, &value.x);
    }
    void set(GLint location, const glm::vec4& value) const {
        glProgramUniform4fv(id(), location, 1, &value.x);
    }
    void set(GLint location, const glm::ivec2& value) const {
        glProgramUniform2iv(id(), location, 1, &value.x);
    }
    void set(GLint location, const glm::ivec3& value) const {
        glProgramUniform3iv(id(), location, 1, &value.x);
    }
    void set(GLint location, const glm::ivec4& value) const {
        glProgramUniform4iv(id(), location, 1, &value.x);
    }
    void set(GLint location, const glm::mat4& value) const {
        glProgramUniformMatrix4fv(id(), location, 1, GL_FALSE, &value[0].x);
    }

  private:
    struct Traits {
        static void destroy(GLuint id) { glDeleteProgram(id); }
    };
    Object<Traits> object_;
};

// The shaders built into the executable.
ShaderLookup built_in_shaders();

}  // namespace ridgeline::gl
