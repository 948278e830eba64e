// The program as a set of subcommands: what each says on the command line, and what it runs.
//
// A subcommand is one file of app/commands with one function add_NAME(Program&), which declares its options
// and hands over what to run once they are parsed. What the options say wrongly is an Error of whatever reads
// them, which the parser turns into wrong usage (exit status 2); what fails while running is a Result too
// (exit status 1). main prints either as one line. Everything here belongs to the main thread.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "ridgeline/app/options.h"
#include "ridgeline/app/syntax.h"
#include "ridgeline/base/result.h"

namespace ridgeline::app {

struct RunContext {
    bool quiet = false;  // no progress, no summaries
};

using Run = std::function<Result<void>(const RunContext&)>;

class Program {
  public:
    explicit Program(const ProgramText& text) : line_(text) {}

    // What every subcommand takes.
    Syntax syntax() const { return line_.syntax(); }
    // `example` stands at the foot of the subcommand's help.
    Syntax add(const std::string& name, const std::string& what, const std::string& example) const;
    void runs(const std::string& name, Run run) { runs_[name] = std::move(run); }
    // What the subcommand that was named runs; null: help or the version was asked for, and is printed.
    Result<const Run*> parse(int argc, const char* const* argv) const;
    Usage usage() const { return line_.usage(); }

  private:
    CommandLine line_;
    std::map<std::string, Run> runs_;
};

// An option with named values, of which the first is the default.
Option add_choice(Syntax syntax, const std::string& name, std::string& target,
                  const std::vector<std::string>& offered, const std::string& help);

// The store that a subcommand reads.
void add_store(Syntax syntax, std::filesystem::path& directory);

// --ram-cache and --gpu-cache.
void add_caches(Syntax syntax, CacheSizes& caches);

// The subcommands, each in the file of its name.
void add_synth(Program& program);
void add_build(Program& program);
void add_info(Program& program);
void add_verify(Program& program);
void add_height(Program& program);
void add_walk(Program& program);
void add_bench(Program& program);
void add_report(Program& program);

}  // namespace ridgeline::app
