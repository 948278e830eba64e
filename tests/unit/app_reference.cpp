// The manual page and the shell completion, against what the program's own help offers: every option of every
// command is in both, and bash completes it.
#include <doctest/doctest.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>

#include "ridgeline/app/program.h"
#include "ridgeline/app/reference/bash_completion.h"
#include "ridgeline/app/reference/man_page.h"
#include "unit/app_process.h"

namespace ridgeline::test {
namespace {

using Words = std::set<std::string>;

app::Usage program_usage() {
    app::GlobalOptions options;
    app::Program program(app::program_text());
    app::add_everything(program, options);
    return program.usage();
}

// The options that a help text lists: the words with dashes at the beginning of its lines.
Words listed_options(const std::string& help) {
    Words options;
    std::istringstream lines(help);
    for (std::string line; std::getline(lines, line);) {
        const auto begin = line.find_first_not_of(' ');
        if (begin == std::string::npos || begin == 0 || line[begin] != '-') continue;
        std::istringstream names(line.substr(begin, line.find_first_of(" =", begin) - begin));
        for (std::string name; std::getline(names, name, ',');) options.insert(name);
    }
    return options;
}

std::vector<std::string> command_names(const app::Usage& usage) {
    std::vector<std::string> names;
    for (const auto& command : usage.commands) names.push_back(command.name);
    return names;
}

// A manual page's text without its roff.
std::string plain(std::string page) {
    for (const std::string mark : {"\\fB", "\\fI", "\\fR", "\\&"})
        for (auto at = page.find(mark); at != std::string::npos; at = page.find(mark))
            page.erase(at, mark.size());
    for (auto at = page.find("\\-"); at != std::string::npos; at = page.find("\\-")) page.erase(at, 1);
    return page;
}

std::string section_of(const std::string& page, const std::string& command) {
    const auto begin = page.find(".SS ridgeline " + command + "\n");
    REQUIRE(begin != std::string::npos);
    return page.substr(begin, page.find("\n.S", begin + 1) - begin);
}

// What bash completes after these words, the last of which is begun.
class Completion {
  public:
    Completion() {
        std::ofstream(folder_.file("ridgeline.bash")) << app::bash_completion(program_usage());
        std::ofstream(folder_.file("complete")) << "source \"$1/ridgeline.bash\"; shift\n"
                                                   "cd \"$1\"; shift\n"
                                                   "COMP_WORDS=(\"$@\") COMP_CWORD=$(($# - 1))\n"
                                                   "_ridgeline && printf '%s\\n' \"${COMPREPLY[@]}\"\n";
    }
    Words after(const std::string& words) const {
        const std::string out = folder_.file("out");
        const std::string command = "bash -eu '" + folder_.file("complete") + "' '" +
                                    folder_.path().string() + "' '" + folder_.path().string() +
                                    "' ridgeline " + words + " >'" + out + "'";
        REQUIRE(std::system(command.c_str()) == 0);
        std::istringstream lines(file_text(out));
        Words found;
        for (std::string line; std::getline(lines, line);)
            if (!line.empty()) found.insert(line);
        return found;
    }

  private:
    Folder folder_;
};

}  // namespace

TEST_CASE("reference: every option that a command's help lists is in the manual and completed") {
    const app::Usage usage = program_usage();
    const std::string page = plain(app::man_page(usage));
    const Completion completion;
    std::size_t options = 0;
    for (const std::string& command : command_names(usage)) {
        const Words listed = listed_options(run({command, "--help"}).out);
        CHECK(listed.contains("--help"));
        const std::string section = section_of(page, command);
        const Words completed = completion.after(command + " -");
        for (const std::string& option : listed) {
            INFO(command << " " << option);
            const bool in_manual = section.find("\n.TP\n" + option) != std::string::npos ||
                                   section.find(", " + option) != std::string::npos;
            CHECK(in_manual);
            CHECK(completed.contains(option));
            ++options;
        }
        // Nothing that the help does not offer, but what may stand everywhere.
        for (const std::string& option : completed) {
            INFO(command << " " << option);
            const bool everywhere = option == "--quiet" || option == "--log-level";
            CHECK((everywhere || listed.contains(option)));
        }
    }
    CHECK(options > 50);
}

TEST_CASE(
    "reference: the manual has every command, example and exit status, and no line that roff misreads") {
    const app::Usage usage = program_usage();
    const std::string roff = app::man_page(usage);
    for (const std::string& command : command_names(usage))
        CHECK(plain(section_of(plain(roff), command)).find("ridgeline " + command) != std::string::npos);
    CHECK(roff.find(".SH EXIT STATUS\n") != std::string::npos);
    CHECK(plain(roff).find("ridgeline walk alps.terrain --headless") != std::string::npos);
    std::istringstream lines(roff);
    for (std::string line; std::getline(lines, line);) {
        INFO(line);
        if (line.starts_with('.'))
            CHECK(std::set<std::string>{".TH", ".SH", ".SS", ".TP", ".PP", ".nf", ".fi"}.contains(
                line.substr(0, 3)));
        CHECK(!line.starts_with('\''));
    }
    CHECK(app::man_page(usage) == roff);
}

TEST_CASE("reference: text that roff would take for commands is kept as text") {
    app::Usage usage{.program = "ridgeline", .version = "1", .everywhere = {}, .commands = {}};
    usage.everywhere.what = "'quoted'\n.so a\\b-c";
    usage.everywhere.groups.emplace_back();
    CHECK(app::man_page(usage).find("\\&'quoted'\n\\&.so a\\eb\\-c\n") != std::string::npos);
}

TEST_CASE("reference: bash completes commands, values and files") {
    const Completion completion;
    CHECK(completion.after("''") ==
          Words{"synth", "build", "info", "verify", "height", "walk", "bench", "report"});
    CHECK(completion.after("--") == Words{"--help", "--version", "--quiet", "--log-level"});
    CHECK(completion.after("w") == Words{"walk"});
    CHECK(completion.after("walk x.terrain --surface ''") == Words{"mesh", "disc", "quadtree"});
    CHECK(completion.after("walk x.terrain --surface = d") == Words{"disc"});
    CHECK(completion.after("walk x.terrain --surface =") == Words{"mesh", "disc", "quadtree"});
    CHECK(completion.after("walk --path o") == Words{"orbit", "out"});
    CHECK(completion.after("info rid") == Words{"ridgeline.bash"});
    CHECK(completion.after("walk --frames ''").empty());
    // A value that is called as a command is.
    CHECK(completion.after("--log-level info w") == Words{"walk"});
    CHECK(completion.after("--log-level = info w") == Words{"walk"});
    CHECK(completion.after("verify --log-level e") == Words{"error"});
}

TEST_CASE("reference: small letters are values, capitals stand for what the user makes up") {
    using List = std::vector<std::string>;
    CHECK(app::offered_values("mesh, disc or quadtree") == List{"mesh", "disc", "quadtree"});
    CHECK(app::offered_values("ground|orbit|FILE") == List{"ground", "orbit"});
    CHECK(app::offered_values("WxH").empty());
    CHECK(app::offered_values("EAST,NORTH").empty());
    CHECK(app::offered_values("").empty());
    CHECK(app::names_file("ground|orbit|FILE"));
    CHECK(app::names_file("DIR.terrain"));
    CHECK(!app::names_file("N"));
}

}  // namespace ridgeline::test
