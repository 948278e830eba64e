#include "ridgeline/app/reference/bash_completion.h"

namespace ridgeline::app {
namespace {

std::string joined(const std::vector<std::string>& words, const std::string& between) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
    return text;
}

template <class Visit>
void visit_options(const UsageCommand& command, const Visit& visit) {
    for (const UsageGroup& group : command.groups)
        for (const UsageOption& option : group.options)
            if (!option.is_position()) visit(option);
}

std::string names_of(const UsageCommand& command) {
    std::string names;
    visit_options(command, [&](const UsageOption& option) {
        names += (names.empty() ? "" : " ") + joined(option.names, " ");
    });
    return names;
}

// What may follow an option, as a case of the word before: "walk:--surface) words='mesh disc' ;;".
std::string value_case(const std::string& command, const UsageOption& option) {
    if (option.value_name.empty()) return {};
    const std::string patterns = command + ":" + joined(option.names, "|" + command + ":");
    std::string text = "        " + patterns + ") value=1";
    if (const auto values = offered_values(option.value_name); !values.empty())
        text += " words='" + joined(values, " ") + "'";
    if (names_file(option.value_name)) text += " files=1";
    return text + " ;;\n";
}

std::string value_cases(const Usage& usage) {
    std::string cases;
    for (const UsageCommand& command : usage.commands)
        visit_options(command, [&](const UsageOption& option) { cases += value_case(command.name, option); });
    visit_options(usage.everywhere, [&](const UsageOption& option) { cases += value_case("*", option); });
    return cases;
}

// Options before a command whose value may be called as a command is.
std::string valued_everywhere(const Usage& usage) {
    std::string pattern;
    visit_options(usage.everywhere, [&](const UsageOption& option) {
        if (!option.value_name.empty()) pattern += joined(option.names, "|") + "|";
    });
    return pattern;
}

std::string option_cases(const Usage& usage) {
    const std::string everywhere = names_of(usage.everywhere);
    std::string cases;
    for (const UsageCommand& command : usage.commands)
        cases += "        " + command.name + ") words='" + names_of(command) + " --quiet --log-level' ;;\n";
    return cases + "        *) words='" + everywhere + "' ;;\n";
}

std::string command_names(const Usage& usage) {
    std::string names;
    for (const UsageCommand& command : usage.commands) names += (names.empty() ? "" : " ") + command.name;
    return names;
}

std::string command_pattern(const Usage& usage) {
    std::string pattern;
    for (const UsageCommand& command : usage.commands) pattern += (pattern.empty() ? "" : "|") + command.name;
    return pattern;
}

}  // namespace

std::string bash_completion(const Usage& usage) {
    return "# bash completion for " + usage.program + " " + usage.version +
           ", generated from its options.\n"
           "_ridgeline() {\n"
           "    local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]}\n"
           "    local command='' words='' value='' files='' at\n"
           "    # --option=value comes as three words.\n"
           "    if [[ $current == '=' ]]; then\n"
           "        current=''\n"
           "    elif [[ $before == '=' ]]; then\n"
           "        before=${COMP_WORDS[COMP_CWORD - 2]}\n"
           "    fi\n"
           "    for ((at = 1; at < COMP_CWORD; ++at)); do\n"
           "        case ${COMP_WORDS[at - 1]} in\n"
           "            " +
           valued_everywhere(usage) +
           "=) continue ;;\n"
           "        esac\n"
           "        case ${COMP_WORDS[at]} in\n"
           "            " +
           command_pattern(usage) +
           ") command=${COMP_WORDS[at]} && break ;;\n"
           "        esac\n"
           "    done\n"
           "    case $command:$before in\n" +
           value_cases(usage) +
           "    esac\n"
           "    if [[ -z $value && $current == -* ]]; then\n"
           "        case $command in\n" +
           option_cases(usage) +
           "        esac\n"
           "    elif [[ -z $value && -z $command ]]; then\n"
           "        words='" +
           command_names(usage) +
           "'\n"
           "    elif [[ -z $value ]]; then\n"
           "        files=1\n"
           "    fi\n"
           "    mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$current\")\n"
           "    if [[ -n $files ]]; then\n"
           "        compopt -o filenames 2>/dev/null\n"
           "        mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -f -- \"$current\")\n"
           "    fi\n"
           "}\n"
           "complete -F _ridgeline " +
           usage.program + "\n";
}

}  // namespace ridgeline::app
