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

constexpr const char* kLacking = "not in this release";

auto chosen_from(const Choice& choice) {
    return [choice](const std::string& text) -> Result<std::string> {
        if (holds(choice.offered, text)) return text;
        const std::string mend = ": use " + listed(choice.offered);
        if (holds(choice.lacking, text)) return Error{"'" + text + "' is " + kLacking + mend};
        return Error{"'" + text + "' is not known" + mend};
    };
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

Option add_choice(Syntax syntax, const std::string& name, std::string& target, const Choice& choice,
                  const std::string& help) {
    target = choice.offered.front();
    return add_value(syntax, name, target, listed(choice.offered), help, chosen_from(choice))
        .shown_default(choice.offered.front());
}

Option add_choice(Syntax syntax, const std::string& name, std::optional<std::string>& target,
                  const Choice& choice, const std::string& help) {
    return add_value(syntax, name, target, listed(choice.offered), help, chosen_from(choice))
        .shown_default(choice.offered.front());
}

void refuse_option(Syntax syntax, const std::string& name) { syntax.refuse_option(name, kLacking); }

void refuse_flag(Syntax syntax, const std::string& name) { syntax.refuse_flag(name, kLacking); }

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
