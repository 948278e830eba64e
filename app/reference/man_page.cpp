#include "ridgeline/app/reference/man_page.h"

namespace ridgeline::app {
namespace {

// Text as it stands: roff would take a line's first dot for a command, a backslash for an escape, and a hyphen
// for one that may not be typed.
std::string literal(const std::string& text) {
    std::string roff;
    bool line_begins = true;
    for (const char c : text) {
        if (line_begins && (c == '.' || c == '\'')) roff += "\\&";
        if (c == '\\')
            roff += "\\e";
        else if (c == '-')
            roff += "\\-";
        else
            roff += c;
        line_begins = c == '\n';
    }
    return roff;
}

std::string bold(const std::string& text) { return "\\fB" + literal(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + literal(text) + "\\fR"; }

// "--at EAST,NORTH ..."
std::string option_head(const UsageOption& option) {
    std::string head;
    for (const std::string& name : option.names)
        head += (head.empty() ? "" : ", ") + (option.is_position() ? italic(name) : bold(name));
    if (!option.value_name.empty() && !option.is_position()) head += " " + italic(option.value_name);
    if (option.repeats) head += " ...";
    return head;
}

std::string option_text(const UsageOption& option) {
    std::string text = ".TP\n" + option_head(option) + "\n" + literal(option.help);
    if (option.required) text += " (required)";
    if (!option.shown_default.empty()) text += " (default: " + literal(option.shown_default) + ")";
    return text + "\n";
}

std::string synopsis(const Usage& usage, const UsageCommand& command) {
    std::string text = bold(usage.program + " " + command.name) + " [OPTIONS]";
    for (const UsageOption& option : command.groups.front().options) {
        if (!option.is_position()) continue;
        const std::string name = italic(option.names.front()) + (option.repeats ? "..." : "");
        text += option.required ? " " + name : " [" + name + "]";
    }
    return text;
}

std::string groups_text(const UsageCommand& command) {
    std::string text;
    for (const UsageGroup& group : command.groups) {
        if (!group.title.empty()) text += ".PP\n" + bold(group.title) + "\n";
        for (const UsageOption& option : group.options) text += option_text(option);
    }
    return text;
}

// Examples keep their lines.
std::string footer_text(const UsageCommand& command) {
    return command.footer.empty() ? "" : ".PP\n.nf\n" + literal(command.footer) + "\n.fi\n";
}

std::string command_text(const Usage& usage, const UsageCommand& command) {
    return ".SS " + literal(usage.program + " " + command.name) + "\n" + synopsis(usage, command) +
           "\n.PP\n" + literal(command.what) + ".\n" + groups_text(command) + footer_text(command);
}

constexpr const char* kExitStatus =
    ".SH EXIT STATUS\n"
    ".TP\n0\nDone.\n"
    ".TP\n1\nThe run failed: unreadable data, a full disk, a check that found damage.\n"
    ".TP\n2\nWrong usage.\n"
    ".PP\nA failure is one line on standard error.\n";

}  // namespace

std::string man_page(const Usage& usage) {
    std::string page =
        ".TH RIDGELINE 1 \"\" \"Ridgeline " + literal(usage.version) + "\" \"User Commands\"\n";
    page += ".SH NAME\n" + usage.program + " \\- " + literal(usage.everywhere.what) + "\n";
    page += ".SH SYNOPSIS\n" + bold(usage.program) + " " + italic("COMMAND") + " [OPTIONS]\n";
    page += ".SH OPTIONS\n" + groups_text(usage.everywhere);
    page += ".SH COMMANDS\n";
    for (const UsageCommand& command : usage.commands) page += command_text(usage, command);
    page += kExitStatus;
    page += ".SH EXAMPLES\n" + footer_text(usage.everywhere);
    return page;
}

}  // namespace ridgeline::app
