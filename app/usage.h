// What a command line takes, as plain values: for whatever is written from it.
#pragma once

#include <string>
#include <vector>

namespace ridgeline::app {

// An option, or a position: a name without dashes.
struct UsageOption {
    std::vector<std::string> names;  // "-h", "--help"
    // What stands for its value, as the help shows it; empty: it takes none. Words in small letters are
    // values, those in capitals stand for what the user makes up: "ground|orbit|FILE", "cone or geometric".
    std::string value_name;
    std::string help;
    std::string shown_default;
    bool required = false;
    bool repeats = false;  // takes several values

    bool is_position() const { return !names.front().starts_with('-'); }
};

// The values among the words of a value's name.
std::vector<std::string> offered_values(const std::string& value_name);
// Whether it stands for a file or a folder.
bool names_file(const std::string& value_name);

struct UsageGroup {
    std::string title;  // empty: of options that stand under none
    std::vector<UsageOption> options;
};

struct UsageCommand {
    std::string name;  // empty: what stands before a command
    std::string what;
    std::string footer;
    std::vector<UsageGroup> groups;
};

struct Usage {
    std::string program;
    std::string version;
    UsageCommand everywhere;
    std::vector<UsageCommand> commands;
};

}  // namespace ridgeline::app
