#include "ridgeline/gl/program.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "ridgeline/base/log.h"
#include "ridgeline/gl/debug_output.h"
#include "ridgeline/shaders/shader_source.h"

namespace ridgeline::gl {

namespace {

struct ShaderTraits {
    static void destroy(GLuint id) { glDeleteShader(id); }
};
using Shader = Object<ShaderTraits>;

GLenum stage_of(std::string_view path) {
    struct Stage {
        std::string_view ending;
        GLenum stage;
    };
    static constexpr std::array kStages = {
        Stage{".vert", GL_VERTEX_SHADER},       Stage{".frag", GL_FRAGMENT_SHADER},
        Stage{".comp", GL_COMPUTE_SHADER},      Stage{".geom", GL_GEOMETRY_SHADER},
        Stage{".tesc", GL_TESS_CONTROL_SHADER}, Stage{".tese", GL_TESS_EVALUATION_SHADER}};
    const auto found =
        std::ranges::find_if(kStages, [&](const Stage& s) { return path.ends_with(s.ending); });
    RIDGELINE_CHECK(found != kStages.end());
    return found->stage;
}

std::string log_of(GLuint id, decltype(glad_glGetShaderInfoLog) get_log) {
    std::string log(4096, '\0');
    GLsizei length = 0;
    get_log(id, static_cast<GLsizei>(log.size()), &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    return log;
}

// An error is one line: the compiler's first complaint. All of it goes to the log.
Error first_complaint(const std::string& what, const std::string& log) {
    log_line(LogLevel::debug, what + ":\n" + log);
    const auto line = log.find("error");
    const auto begin = line == std::string::npos ? 0 : log.rfind('\n', line) + 1;
    return Error{what + ": " + log.substr(begin, log.find('\n', begin) - begin)};
}

Result<Shader> compile(const std::string& path, std::span<const ShaderDefine> defines,
                       const ShaderLookup& lookup) {
    const auto source = expand_shader(path, defines, lookup);
    if (!source) return source.error();
    Shader shader(glCreateShader(stage_of(path)));
    const GLchar* text = source->text.c_str();
    glShaderSource(shader.id(), 1, &text, nullptr);
    glCompileShader(shader.id());
    GLint compiled = GL_FALSE;
    glGetShaderiv(shader.id(), GL_COMPILE_STATUS, &compiled);
    const std::string log = explain_log(log_of(shader.id(), glGetShaderInfoLog), *source);
    if (compiled == GL_FALSE) return first_complaint("shader " + path, log);
    if (!log.empty()) log_line(LogLevel::debug, "shader " + path + ":\n" + log);
    return shader;
}

std::string name_of(const std::vector<std::string>& stages) {
    std::string name;
    for (const auto& stage : stages) name += (name.empty() ? "" : " + ") + stage;
    return name;
}

}  // namespace

Result<Program> Program::create(const ProgramOptions& options) { return create(options, built_in_shaders()); }

Result<Program> Program::create(const ProgramOptions& options, const ShaderLookup& lookup) {
    RIDGELINE_ASSERT_ROLE(render);
    RIDGELINE_CHECK(!options.stages.empty());
    Program program;
    program.object_ = Object<Traits>(glCreateProgram());
    for (const auto& stage : options.stages) {
        const auto shader = compile(stage, options.defines, lookup);
        if (!shader) return shader.error();
        // The program keeps the shader alive until it goes itself.
        glAttachShader(program.id(), shader->id());
    }
    glLinkProgram(program.id());
    GLint linked = GL_FALSE;
    glGetProgramiv(program.id(), GL_LINK_STATUS, &linked);
    const std::string name = name_of(options.stages);
    if (linked == GL_FALSE)
        return first_complaint("shaders " + name, log_of(program.id(), glGetProgramInfoLog));
    set_label(GL_PROGRAM, program.id(), name);
    return program;
}

ShaderLookup built_in_shaders() { return shaders::shader_source; }

}  // namespace ridgeline::gl
