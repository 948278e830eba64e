#include "ridgeline/gl/shader_source.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <filesystem>

namespace ridgeline::gl {

namespace {

std::string_view trimmed_left(std::string_view line) {
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    return line;
}

// The file named by a line `#include "file"`.
std::optional<std::string_view> included_file(std::string_view line) {
    if (!trimmed_left(line).starts_with("#include")) return std::nullopt;
    const auto open = line.find('"');
    const auto close = line.rfind('"');
    if (open == close) return std::nullopt;
    return line.substr(open + 1, close - open - 1);
}

// What only C++ understands, and does without harm to GLSL when it is gone.
bool is_for_cpp(std::string_view line) {
    line = trimmed_left(line);
    return line.starts_with("#pragma once") || line.starts_with("#include <");
}

std::string beside(std::string_view includer, std::string_view file) {
    return (std::filesystem::path(includer).parent_path() / file).lexically_normal().generic_string();
}

class Expander {
  public:
    explicit Expander(const ShaderLookup& lookup) : lookup_(lookup) {}

    Result<ShaderSource> expand(const std::string& path, std::span<const ShaderDefine> defines) {
        const auto text = lookup_(path);
        if (!text) return Error{path + ": there is no such shader"};
        if (!text->starts_with("#version")) return Error{path + ":1: a shader opens with its #version line"};
        RIDGELINE_TRY(add_file(path, *text, defines));
        return std::move(out_);
    }

  private:
    using Place = ShaderSource::Place;

    // The defines go between the first line, which is the version, and the second.
    Result<void> add_file(const std::string& path, std::string_view text,
                          std::span<const ShaderDefine> defines = {}) {
        Place place{.file = out_.files.size(), .line = 1};
        out_.files.push_back(path);
        for (; !text.empty(); ++place.line) {
            const auto end = std::min(text.find('\n'), text.size());
            RIDGELINE_TRY(add_line(text.substr(0, end), place));
            text.remove_prefix(std::min(end + 1, text.size()));
            if (place.line > 1) continue;
            for (const auto& [name, value] : defines) {
                std::string line = "#define ";
                append(line.append(name).append(" ").append(value), place);
            }
        }
        return {};
    }

    Result<void> add_line(std::string_view line, Place place) {
        const auto file = included_file(line);
        if (!file) {
            append(is_for_cpp(line) ? std::string_view() : line, place);
            return {};
        }
        const std::string& includer = out_.files[place.file];
        const std::string included = beside(includer, *file);
        if (std::ranges::find(out_.files, included) != out_.files.end()) return {};
        const auto text = lookup_(included);
        if (text) return add_file(included, *text);
        return Error{includer + ":" + std::to_string(place.line) + ": there is no shader file '" + included +
                     "'"};
    }

    void append(std::string_view line, Place place) {
        out_.text.append(line).append("\n");
        out_.lines.push_back(place);
    }

    const ShaderLookup& lookup_;
    ShaderSource out_;
};

std::optional<std::size_t> take_number(std::string_view& text) {
    std::size_t number = 0;
    const auto [rest, failed] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (failed != std::errc()) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(rest - text.data()));
    return number;
}

bool take(std::string_view& text, std::string_view prefix) {
    if (!text.starts_with(prefix)) return false;
    text.remove_prefix(prefix.size());
    return true;
}

// Mesa writes "0:LINE(COLUMN): ", NVIDIA "0(LINE) : ", others "ERROR: 0:LINE: ".
std::string explain_line(std::string_view line, const ShaderSource& source) {
    std::string_view rest = line;
    take(rest, "ERROR: ");
    const bool numbered = take_number(rest).has_value();
    const bool in_brackets = rest.starts_with("(");
    if (!numbered || !(take(rest, ":") || take(rest, "("))) return std::string(line);
    const auto number = take_number(rest);
    if (!number || *number == 0 || *number > source.lines.size()) return std::string(line);
    if (in_brackets) take(rest, ")");
    const auto& place = source.lines[*number - 1];
    return source.files[place.file] + ":" + std::to_string(place.line) + std::string(rest);
}

}  // namespace

Result<ShaderSource> expand_shader(const std::string& path, std::span<const ShaderDefine> defines,
                                   const ShaderLookup& lookup) {
    return Expander(lookup).expand(path, defines);
}

std::string explain_log(std::string_view log, const ShaderSource& source) {
    std::string explained;
    while (!log.empty()) {
        const auto end = std::min(log.find('\n'), log.size());
        explained += explain_line(log.substr(0, end), source) + "\n";
        log.remove_prefix(std::min(end + 1, log.size()));
    }
    return explained;
}

}  // namespace ridgeline::gl
