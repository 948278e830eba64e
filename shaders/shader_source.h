// The text of the shaders, built into the program. Constant data; any thread.
#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace ridgeline::shaders {

struct ShaderFile {
    std::string_view path;  // from the folder shaders/: "passes/terrain.vert"
    std::string_view text;
};

// All of them, in the order of shaders/CMakeLists.txt.
std::span<const ShaderFile> shader_files();

std::optional<std::string_view> shader_source(std::string_view path);

}  // namespace ridgeline::shaders
