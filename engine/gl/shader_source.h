// Shader text before the compiler sees it: #include, defines, and the way back from the compiler's log to the
// files.
//
// GLSL has no #include. Here #include "file" works as in C++, relative to the including file, each file once,
// so that the same header serves both languages; #include <file> is C++'s own and vanishes. The place of
// every line is kept here rather than told by #line, whose file numbers Mesa 22.3 forgets in errors about
// names. Pure text; any thread.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ridgeline/base/result.h"

namespace ridgeline::gl {

// The text of a file by its path from the folder shaders/, or nothing.
using ShaderLookup = std::function<std::optional<std::string_view>(std::string_view path)>;

struct ShaderDefine {
    std::string name;
    std::string value{};
};

struct ShaderSource {
    struct Place {
        std::size_t file = 0;  // in files
        int line = 0;          // from 1
    };
    std::string text;
    std::vector<std::string> files;
    std::vector<Place> lines;  // where each line of the text comes from
};

// The file must open with its #version line; the defines follow that.
Result<ShaderSource> expand_shader(const std::string& path, std::span<const ShaderDefine> defines,
                                   const ShaderLookup& lookup);

// Replaces "0:12(3)", "0(12)" and "ERROR: 0:12" at the start of the log's lines by "file:line".
std::string explain_log(std::string_view log, const ShaderSource& source);

}  // namespace ridgeline::gl
