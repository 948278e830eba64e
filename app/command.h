// The program as a set of subcommands: what each says on the command line, and what it runs.
//
// A subcommand is one file of app/commands with one function add_NAME(Program&), which declares its options
// and hands over what to run once they are parsed. What the options say wrongly is thrown to the parser as
// wrong usage (exit status 2) by the helpers of this header; what fails while running is a Result (exit
// status 1). main prints either as one line. Everything here belongs to the main thread but RunContext::stop,
// which any thread may read.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "ridgeline/app/options.h"
#include "ridgeline/base/result.h"

namespace ridgeline::app {

struct RunContext {
    bool quiet = false;  // no progress, no summaries
};

using Run = std::function<Result<void>(const RunContext&)>;

class Program {
  public:
    explicit Program(CLI::App& syntax) : syntax_(syntax) {}

    // `example` stands at the foot of the subcommand's help.
    CLI::App& add(const std::string& name, const std::string& what, const std::string& example);
    void runs(const CLI::App& subcommand, Run run) { runs_.emplace_back(&subcommand, std::move(run)); }
    // What the subcommand that was named runs; none was named: nothing.
    const Run* chosen() const;

  private:
    CLI::App& syntax_;
    std::vector<std::pair<const CLI::App*, Run>> runs_;
};

// Adds an option with one value, which `parse`, Result<T>(const std::string&), reads.
template <class T, class Parse>
CLI::Option* add_value(CLI::App& syntax, const std::string& name, T& target, const std::string& value_name,
                       const std::string& help, Parse parse) {
    const auto read = [name, &target, parse](const std::string& text) {
        auto value = parse(text);
        if (!value) throw CLI::ValidationError(name, value.error().message);
        target = std::move(value).value();
    };
    return syntax.add_option_function<std::string>(name, read, help)->type_name(value_name);
}

// The same for an option that may be repeated and takes several values at once; `target` is a vector of T.
template <class T, class Parse>
CLI::Option* add_values(CLI::App& syntax, const std::string& name, std::vector<T>& target,
                        const std::string& value_name, const std::string& help, Parse parse) {
    const auto read = [name, &target, parse](const std::vector<std::string>& texts) {
        for (const std::string& text : texts) {
            auto value = parse(text);
            if (!value) throw CLI::ValidationError(name, value.error().message);
            target.push_back(std::move(value).value());
        }
    };
    return syntax.add_option_function<std::vector<std::string>>(name, read, help)->type_name(value_name);
}

// What an option with named values offers. Values of systems that this release lacks are refused as such.
struct Choice {
    std::vector<std::string> offered;  // the first is the default
    std::vector<std::string> lacking;
};
CLI::Option* add_choice(CLI::App& syntax, const std::string& name, std::string& target, const Choice& choice,
                        const std::string& help);

// Options whose system this release lacks: any use is wrong usage, and help does not offer them.
void refuse_option(CLI::App& syntax, const std::string& name);
void refuse_flag(CLI::App& syntax, const std::string& name);

// The store that a subcommand reads.
void add_store(CLI::App& syntax, std::filesystem::path& directory);

// --ram-cache and --gpu-cache.
void add_caches(CLI::App& syntax, CacheSizes& caches);

// The subcommands, each in the file of its name.
void add_synth(Program& program);
void add_build(Program& program);
void add_info(Program& program);
void add_verify(Program& program);
void add_height(Program& program);
void add_walk(Program& program);
void add_bench(Program& program);

}  // namespace ridgeline::app
