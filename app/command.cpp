#include "ridgeline/app/command.h"

#include <algorithm>

namespace ridgeline::app {
namespace {

std::string listed(const std::vector<std::string>& words) {
    std::string text;
    for (std::size_t i = 0; i < words.size(); ++i)
        text += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + words[i];
    return text;
}

bool holds(const std::vector<std::string>& words, const std::string& word) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

}  // namespace

Syntax Program::add(const std::string& name, const std::string& what, const std::string& example) const {
    return line_.add_subcommand(name, what,
                                "Example:\n  " + example + "\n\nEverywhere: --quiet, --log-level LEVEL");
}

Result<const Run*> Program::parse(int argc, const char* const* argv) const {
    const auto named = line_.parse(argc, argv);
    if (!named) return named.error();
    return *named ? &runs_.at(**named) : nullptr;
}

Option add_choice(Syntax syntax, const std::string& name, std::string& target,
                  const std::vector<std::string>& offered, const std::string& help) {
    target = offered.front();
    const auto parse = [offered](const std::string& text) -> Result<std::string> {
        if (holds(offered, text)) return text;
        return Error{"'" + text + "' is not known: use " + listed(offered)};
    };
    return add_value(syntax, name, target, listed(offered), help, parse).shown_default(target);
}

void add_store(Syntax syntax, std::filesystem::path& directory) {
    add_path(syntax, "DIR.terrain", directory, "", "The store").required();
}

void add_caches(Syntax syntax, CacheSizes& caches) {
    add_value(syntax, "--ram-cache", caches.ram_bytes, "SIZE", "Decoded tiles in memory, never more",
              parse_capacity)
        .shown_default("256MiB");
    add_value(syntax, "--gpu-cache", caches.gpu_bytes, "SIZE", "Tiles on the GPU, never more", parse_capacity)
        .shown_default("512MiB");
}

}  // namespace ridgeline::app
