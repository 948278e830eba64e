#include <doctest/doctest.h>

#include <map>
#include <utility>

#include "ridgeline/gl/shader_source.h"

namespace ridgeline::gl {
namespace {

using Files = std::map<std::string, std::string, std::less<>>;

ShaderLookup lookup_in(const Files& files) {
    return [&files](std::string_view path) -> std::optional<std::string_view> {
        const auto found = files.find(path);
        if (found == files.end()) return std::nullopt;
        return found->second;
    };
}

TEST_CASE("includes are found beside the includer, each once, and every line remembers its place") {
    const Files files = {
        {"passes/a.vert",
         "#version 450 core\n#include \"../lib/b.h\"\n#include \"../shared/c.h\"\nvoid main() {}\n"},
        {"lib/b.h", "#pragma once\n#include <cmath>\n#include \"../shared/c.h\"\nfloat b;\n"},
        {"shared/c.h", "#pragma once\nfloat c;"}};
    const auto source = expand_shader("passes/a.vert", {}, lookup_in(files));
    REQUIRE(source);
    CHECK(source->files == std::vector<std::string>{"passes/a.vert", "lib/b.h", "shared/c.h"});
    CHECK(source->text == "#version 450 core\n\n\n\nfloat c;\nfloat b;\nvoid main() {}\n");
    std::vector<std::pair<std::size_t, int>> places;
    for (const auto& place : source->lines) places.emplace_back(place.file, place.line);
    CHECK(places ==
          std::vector<std::pair<std::size_t, int>>{{0, 1}, {1, 1}, {1, 2}, {2, 1}, {2, 2}, {1, 4}, {0, 4}});
}

TEST_CASE("defines stand right after the version") {
    const Files files = {{"a.comp", "#version 450 core\nvoid main() {}\n"}};
    const ShaderDefine defines[] = {{"N", "4"}, {"FLAG", ""}};
    const auto source = expand_shader("a.comp", defines, lookup_in(files));
    REQUIRE(source);
    CHECK(source->text == "#version 450 core\n#define N 4\n#define FLAG \nvoid main() {}\n");
}

TEST_CASE("files that are missing or have no version are errors with their place") {
    const Files files = {{"a.vert", "#version 450 core\n\n#include \"b.h\"\n"},
                         {"c.vert", "void main() {}\n"}};
    const auto missing = expand_shader("a.vert", {}, lookup_in(files));
    REQUIRE_FALSE(missing);
    CHECK(missing.error().message == "a.vert:3: there is no shader file 'b.h'");
    CHECK_FALSE(expand_shader("c.vert", {}, lookup_in(files)));
    CHECK_FALSE(expand_shader("d.vert", {}, lookup_in(files)));
}

TEST_CASE("line numbers of the log become places in files, for every driver's way of writing") {
    const ShaderSource source{"", {"a.vert", "lib/b.h"}, {{0, 1}, {1, 7}, {0, 3}}};
    CHECK(explain_log("0:2(3): error: no\n", source) == "lib/b.h:7(3): error: no\n");
    CHECK(explain_log("0(3) : error C1008: no", source) == "a.vert:3 : error C1008: no\n");
    CHECK(explain_log("ERROR: 0:2: 'x' : no", source) == "lib/b.h:7: 'x' : no\n");
    CHECK(explain_log("0:9: beyond the end\nno numbers\n", source) == "0:9: beyond the end\nno numbers\n");
    CHECK(explain_log("", source).empty());
}

}  // namespace
}  // namespace ridgeline::gl
