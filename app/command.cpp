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
// CLI11 leaves options of the empty group out of the help.
constexpr const char* kHidden = "";

}  // namespace

CLI::App& Program::add(const std::string& name, const std::string& what, const std::string& example) {
    CLI::App& subcommand = *syntax_.add_subcommand(name, what);
    subcommand.fallthrough();  // so that --quiet and --log-level may stand behind it
    subcommand.footer("Example:\n  " + example + "\n\nEverywhere: --quiet, --log-level LEVEL");
    return subcommand;
}

const Run* Program::chosen() const {
    for (const auto& [subcommand, run] : runs_)
        if (subcommand->parsed()) return &run;
    return nullptr;
}

CLI::Option* add_choice(CLI::App& syntax, const std::string& name, std::string& target, const Choice& choice,
                        const std::string& help) {
    target = choice.offered.front();
    const auto parse = [choice](const std::string& text) -> Result<std::string> {
        if (holds(choice.offered, text)) return text;
        const std::string mend = ": use " + listed(choice.offered);
        if (holds(choice.lacking, text)) return Error{"'" + text + "' is " + kLacking + mend};
        return Error{"'" + text + "' is not known" + mend};
    };
    return add_value(syntax, name, target, listed(choice.offered), help, parse)->default_str(target);
}

void refuse_option(CLI::App& syntax, const std::string& name) {
    const auto refuse = [name](const std::vector<std::string>&) {
        throw CLI::ValidationError(name, kLacking);
    };
    syntax.add_option_function<std::vector<std::string>>(name, refuse)->expected(0, -1)->group(kHidden);
}

void refuse_flag(CLI::App& syntax, const std::string& name) {
    const auto refuse = [name](std::int64_t) { throw CLI::ValidationError(name, kLacking); };
    syntax.add_flag_function(name, refuse)->group(kHidden);
}

void add_store(CLI::App& syntax, std::filesystem::path& directory) {
    syntax.add_option("DIR.terrain", directory, "The store")->required()->type_name("");
}

void add_caches(CLI::App& syntax, CacheSizes& caches) {
    add_value(syntax, "--ram-cache", caches.ram_bytes, "SIZE", "Decoded tiles in memory, never more",
              parse_capacity)
        ->default_str("256MiB");
    add_value(syntax, "--gpu-cache", caches.gpu_bytes, "SIZE", "Tiles on the GPU, never more", parse_capacity)
        ->default_str("512MiB");
}

}  // namespace ridgeline::app
