// The command line as a program declares it: subcommands, their options, and what each value does.
//
// CLI11 parses it and writes the help. Its header takes longer to compile than any subcommand does, so it
// stays behind this one: Syntax and Option are names for what a CommandLine owns, to be copied at will and
// used while it lives. Main thread alone.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ridgeline/app/usage.h"
#include "ridgeline/base/result.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace ridgeline::app {

class Option {
  public:
    explicit Option(CLI::Option& option) : option_(&option) {}

    Option required() const;
    // What holds without it, as the help shows it.
    Option shown_default(const std::string& text) const;
    Option excludes(const Option& other) const;
    // Of those that may be repeated: one value after each name, so that what follows is not taken for
    // another.
    Option one_value_each() const;

  private:
    CLI::Option* option_;
};

// A value as text, taken or refused; the Error is the WHY of "OPTION: WHY".
using ReadValue = std::function<Result<void>(const std::string& text)>;

// What a subcommand, a group of its options, or the program at large takes. Names without dashes are
// positions; `value_name` stands for the value in the help.
class Syntax {
  public:
    explicit Syntax(CLI::App& app) : app_(&app) {}

    Option value(const std::string& name, const std::string& value_name, const std::string& help,
                 ReadValue read) const;
    // May be repeated and take several values at once.
    Option values(const std::string& name, const std::string& value_name, const std::string& help,
                  ReadValue read) const;
    Option flag(const std::string& name, bool& target, const std::string& help) const;
    Option flag(const std::string& name, std::function<void()> given, const std::string& help) const;

    // Options under a title of their own, which are wrong usage, and why, unless `allowed` once all are
    // parsed.
    Syntax group(const std::string& title, std::function<bool()> allowed, const std::string& why) const;
    // Wrong usage of `name`, and why, unless it `holds` once all are parsed.
    void require(const std::string& name, std::function<bool()> holds, const std::string& why) const;

  private:
    CLI::App* app_;
};

struct ProgramText {
    std::string name;
    std::string what;
    std::string version;
    std::string footer;  // of the help
};

class CommandLine {
  public:
    explicit CommandLine(const ProgramText& text);
    ~CommandLine();
    CommandLine(const CommandLine&) = delete;
    CommandLine& operator=(const CommandLine&) = delete;

    // What may stand before a subcommand and behind it.
    Syntax syntax() const;
    Syntax add_subcommand(const std::string& name, const std::string& what, const std::string& footer) const;

    // The subcommand named; none: help or the version was asked for, and is printed. An Error is wrong usage.
    Result<std::optional<std::string>> parse(int argc, const char* const* argv) const;
    // All that the help offers.
    Usage usage() const;

  private:
    std::unique_ptr<CLI::App> app_;
    std::string version_;
};

// --- values of a type

// `parse`, Result<T>(const std::string&), reads the value.
template <class T, class Parse>
Option add_value(Syntax syntax, const std::string& name, T& target, const std::string& value_name,
                 const std::string& help, Parse parse) {
    return syntax.value(name, value_name, help, [&target, parse](const std::string& text) -> Result<void> {
        auto value = parse(text);
        if (!value) return value.error();
        target = std::move(value).value();
        return {};
    });
}

template <class T, class Parse>
Option add_values(Syntax syntax, const std::string& name, std::vector<T>& target,
                  const std::string& value_name, const std::string& help, Parse parse) {
    return syntax.values(name, value_name, help, [&target, parse](const std::string& text) -> Result<void> {
        auto value = parse(text);
        if (!value) return value.error();
        target.push_back(std::move(value).value());
        return {};
    });
}

// Any text will do.
Option add_text(Syntax syntax, const std::string& name, std::string& target, const std::string& value_name,
                const std::string& help);
Option add_texts(Syntax syntax, const std::string& name, std::vector<std::string>& target,
                 const std::string& value_name, const std::string& help);
Option add_path(Syntax syntax, const std::string& name, std::filesystem::path& target,
                const std::string& value_name, const std::string& help);

}  // namespace ridgeline::app
