#include "ridgeline/shaders/shader_source.h"

#include <algorithm>

namespace ridgeline::shaders {

std::optional<std::string_view> shader_source(std::string_view path) {
    const auto files = shader_files();
    const auto found = std::ranges::find(files, path, &ShaderFile::path);
    if (found == files.end()) return std::nullopt;
    return found->text;
}

}  // namespace ridgeline::shaders
