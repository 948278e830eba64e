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

// The file named by a line `#include "file"`, or nothing when the line is no include.
std::optional<std::string_view> included_file(std::string_view line) {
    line = trimmed_left(line);
    if (!line.starts_with("#include")) return std::nullopt;
    const auto open = line.find('"');
    const auto close = line.rfind('"');
    if (open == std::string_view::npos || close == open) return std::string_view{};
    return line.substr(open + 1, close - open - 1);
}

std::string beside(std::string_view includer, std::string_view file) {
    return (std::filesystem::path(includer).parent_path() / file).lexically_normal().generic_string();
}

class Expander {
  public:
    explicit Expander(const ShaderLookup& lookup) : lookup_(lookup) {}

    // The first file's #version line and the defines come before everything else.
    Result<ShaderSource> expand(const std::string& path, std::span<const ShaderDefine> defines) {
        const auto text = lookup_(path);
        if (!text) return Error{path + ": there is no such shader"};
        const auto version_end = text->find('\n');
        if (!text->starts_with("#version") || version_end == std::string_view::npos)
            return Error{path + ":1: a shader opens with its #version line"};
        out_.text = std::string(text->substr(0, version_end + 1));
        for (const auto& [name, value] : defines) out_.text += "#define " + name + " " + value + "\n";
        RIDGELINE_TRY(add_file(path, text->substr(version_end + 1), 2));
        return std::move(out_);
    }

  private:
    Result<void> add_file(const std::string& path, std::string_view text, int first_line) {
        const auto number = out_.files.size();
        out_.files.push_back(path);
        mark_line(first_line, number);
        for (int line_number = first_line; !text.empty(); ++line_number) {
            const auto end = std::min(text.find('\n'), text.size());
            RIDGELINE_TRY(add_line(path, text.substr(0, end), {line_number, number}));
            text.remove_prefix(std::min(end + 1, text.size()));
        }
        return {};
    }

    struct Place {
        int line = 0;
        std::size_t file = 0;
    };

    Result<void> add_line(const std::string& path, std::string_view line, Place place) {
        if (trimmed_left(line).starts_with("#pragma once")) line = {};
        const auto file = included_file(line);
        if (!file) {
            out_.text.append(line).append("\n");
            return {};
        }
        const std::string included = beside(path, *file);
        if (std::ranges::find(out_.files, included) == out_.files.end()) {
            const auto text = lookup_(included);
            if (!text)
                return Error{path + ":" + std::to_string(place.line) + ": there is no shader file '" +
                             included + "'"};
            RIDGELINE_TRY(add_file(included, *text, 1));
        }
        mark_line(place.line + 1, place.file);
        return {};
    }

    void mark_line(int line, std::size_t file) {
        out_.text += "#line " + std::to_string(line) + " " + std::to_string(file) + "\n";
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

// Mesa writes "FILE:LINE(COLUMN): ", NVIDIA "FILE(LINE) : ", others "ERROR: FILE:LINE: ".
std::string explain_line(std::string_view line, std::span<const std::string> files) {
    std::string_view rest = line;
    take(rest, "ERROR: ");
    const auto file = take_number(rest);
    const bool nvidia = file && rest.starts_with("(");
    if (!file || *file >= files.size() || !(take(rest, ":") || take(rest, "("))) return std::string(line);
    const auto number = take_number(rest);
    if (!number) return std::string(line);
    if (nvidia) take(rest, ")");
    return files[*file] + ":" + std::to_string(*number) + std::string(rest);
}

}  // namespace

Result<ShaderSource> expand_shader(const std::string& path, std::span<const ShaderDefine> defines,
                                   const ShaderLookup& lookup) {
    return Expander(lookup).expand(path, defines);
}

std::string explain_log(std::string_view log, std::span<const std::string> files) {
    std::string explained;
    while (!log.empty()) {
        const auto end = std::min(log.find('\n'), log.size());
        explained += explain_line(log.substr(0, end), files) + "\n";
        log.remove_prefix(std::min(end + 1, log.size()));
    }
    return explained;
}

}  // namespace ridgeline::gl
