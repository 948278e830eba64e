#include "ridgeline/app/syntax.h"

#include <CLI/CLI.hpp>

namespace ridgeline::app {
namespace {

// CLI11 leaves options of the empty group out of the help.
constexpr const char* kHidden = "";

void take(const std::string& name, const ReadValue& read, const std::string& text) {
    if (const auto taken = read(text); !taken) throw CLI::ValidationError(name, taken.error().message);
}

// "--out is required" to "--out: is required", so that every line reads WHAT: WHY.
std::string usage_error(std::string message) {
    if (message.find(": ") != std::string::npos) return message;
    for (const char* verb : {" is required", " excludes "})
        if (const auto at = message.find(verb); at != std::string::npos) return message.insert(at, ":");
    return "command line: " + message;
}

// Empty: none was named.
std::string named_subcommand(const CLI::App& app) {
    const auto named = app.get_subcommands();
    return named.empty() ? "" : named.front()->get_name();
}

Result<std::string> only_subcommand(const CLI::App& app) {
    const std::string named = named_subcommand(app);
    const auto strange = app.remaining(true);
    const std::string help = "see ridgeline " + (named.empty() ? "" : named + " ") + "--help";
    if (!strange.empty()) {
        const bool option = strange.front().starts_with('-');
        return Error{strange.front() + ": " +
                     (!named.empty() || option ? "not expected" : "no such command") + ", " + help};
    }
    if (named.empty()) return Error{"no command: " + help};
    return named;
}

std::vector<std::string> names_of(const CLI::Option& option) {
    if (option.get_positional()) return {option.get_single_name()};
    std::vector<std::string> names;
    for (const std::string& name : option.get_snames()) names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
    return names;
}

UsageOption usage_of(const CLI::Option& option) {
    const bool takes_value = option.get_items_expected_max() > 0;
    return {.names = names_of(option),
            .value_name = takes_value ? option.get_type_name() : std::string(),
            .help = option.get_description(),
            .shown_default = option.get_default_str(),
            .required = option.get_required(),
            .repeats = option.get_expected_max() > 1};
}

UsageGroup usage_of_group(const CLI::App& group, const std::string& title) {
    UsageGroup usage{.title = title, .options = {}};
    // A group's own --help is its command's.
    const bool is_command = title.empty();
    for (const CLI::Option* option : group.get_options())
        if (option->get_group() != kHidden && (is_command || option != group.get_help_ptr()))
            usage.options.push_back(usage_of(*option));
    return usage;
}

UsageCommand usage_of_command(const CLI::App& command) {
    UsageCommand usage{.name = command.get_name(),
                       .what = command.get_description(),
                       .footer = command.get_footer(),
                       .groups = {usage_of_group(command, "")}};
    // Groups of options are commands without a name.
    for (const CLI::App* group :
         command.get_subcommands([](const CLI::App* app) { return app->get_name().empty(); }))
        if (auto options = usage_of_group(*group, group->get_group()); !options.options.empty())
            usage.groups.push_back(std::move(options));
    return usage;
}

}  // namespace

// --- options

Option Option::required() const {
    option_->required();
    return *this;
}

Option Option::shown_default(const std::string& text) const {
    option_->default_str(text);
    return *this;
}

Option Option::excludes(const Option& other) const {
    option_->excludes(other.option_);
    return *this;
}

Option Option::one_value_each() const {
    option_->allow_extra_args(false);
    return *this;
}

Option Syntax::value(const std::string& name, const std::string& value_name, const std::string& help,
                     ReadValue read) const {
    const std::function<void(const std::string&)> take_one = [name, read](const std::string& text) {
        take(name, read, text);
    };
    return Option(*app_->add_option_function(name, take_one, help)->type_name(value_name));
}

Option Syntax::values(const std::string& name, const std::string& value_name, const std::string& help,
                      ReadValue read) const {
    const std::function<void(const std::vector<std::string>&)> take_all =
        [name, read](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) take(name, read, text);
        };
    return Option(*app_->add_option_function(name, take_all, help)->type_name(value_name));
}

Option Syntax::flag(const std::string& name, bool& target, const std::string& help) const {
    return Option(*app_->add_flag(name, target, help));
}

Option Syntax::flag(const std::string& name, std::function<void()> given, const std::string& help) const {
    return Option(*app_->add_flag_function(
        name, [given](std::int64_t) { given(); }, help));
}

Syntax Syntax::group(const std::string& title, std::function<bool()> allowed, const std::string& why) const {
    CLI::App& group = *app_->add_option_group(title);
    group.final_callback([&group, allowed, why] {
        if (allowed()) return;
        for (const CLI::Option* option : group.get_options())
            if (option->count() > 0) throw CLI::ValidationError(option->get_name(), why);
    });
    return Syntax(group);
}

void Syntax::require(const std::string& name, std::function<bool()> holds, const std::string& why) const {
    app_->final_callback([name, holds, why] {
        if (!holds()) throw CLI::ValidationError(name, why);
    });
}

Option add_text(Syntax syntax, const std::string& name, std::string& target, const std::string& value_name,
                const std::string& help) {
    return add_value(syntax, name, target, value_name, help,
                     [](const std::string& text) { return Result<std::string>(text); });
}

Option add_texts(Syntax syntax, const std::string& name, std::vector<std::string>& target,
                 const std::string& value_name, const std::string& help) {
    return add_values(syntax, name, target, value_name, help,
                      [](const std::string& text) { return Result<std::string>(text); });
}

Option add_path(Syntax syntax, const std::string& name, std::filesystem::path& target,
                const std::string& value_name, const std::string& help) {
    return add_value(syntax, name, target, value_name, help, [](const std::string& text) {
        return Result<std::filesystem::path>(std::filesystem::path(text));
    });
}

// --- the command line

CommandLine::CommandLine(const ProgramText& text)
    : app_(std::make_unique<CLI::App>(text.what, text.name)), version_(text.version) {
    app_->require_subcommand(0, 1);
    app_->allow_extras();  // only_subcommand says better what is wrong with them
    app_->get_formatter()->label("SUBCOMMAND", "COMMAND ...");
    app_->set_version_flag("--version", text.name + " " + text.version);
    app_->footer(text.footer);
}

CommandLine::~CommandLine() = default;

Syntax CommandLine::syntax() const { return Syntax(*app_); }

Syntax CommandLine::add_subcommand(const std::string& name, const std::string& what,
                                   const std::string& footer) const {
    CLI::App& subcommand = *app_->add_subcommand(name, what);
    subcommand.fallthrough();  // so that --quiet and --log-level may stand behind it
    subcommand.footer(footer);
    return Syntax(subcommand);
}

Result<std::optional<std::string>> CommandLine::parse(int argc, const char* const* argv) const {
    try {
        app_->parse(argc, argv);
    } catch (const CLI::Success& asked) {
        // Help on a command that does not exist would be everybody's help, and no word of what is wrong.
        if (named_subcommand(*app_).empty() && !app_->remaining().empty())
            return only_subcommand(*app_).error();
        app_->exit(asked);
        return std::optional<std::string>();
    } catch (const CLI::Error& error) {
        return Error{usage_error(error.what())};
    }
    auto named = only_subcommand(*app_);
    if (!named) return named.error();
    return std::optional(std::move(named).value());
}

Usage CommandLine::usage() const {
    Usage usage{.program = app_->get_name(),
                .version = version_,
                .everywhere = usage_of_command(*app_),
                .commands = {}};
    usage.everywhere.name.clear();
    for (const CLI::App* command :
         app_->get_subcommands([](const CLI::App* app) { return !app->get_name().empty(); }))
        usage.commands.push_back(usage_of_command(*command));
    return usage;
}

}  // namespace ridgeline::app
