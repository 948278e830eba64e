#include "ridgeline/app/usage.h"

#include <algorithm>

namespace ridgeline::app {
namespace {

bool is_value(const std::string& word) {
    return !word.empty() && std::all_of(word.begin(), word.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
    });
}

std::vector<std::string> words_of(const std::string& text) {
    std::vector<std::string> words(1);
    for (const char c : text) {
        if (c != ' ' && c != ',' && c != '|')
            words.back() += c;
        else if (!words.back().empty())
            words.emplace_back();
    }
    return words;
}

}  // namespace

std::vector<std::string> offered_values(const std::string& value_name) {
    std::vector<std::string> values;
    for (const std::string& word : words_of(value_name))
        if (is_value(word) && word != "or") values.push_back(word);
    return values;
}

bool names_file(const std::string& value_name) {
    for (const std::string& word : words_of(value_name))
        for (const char* kind : {"FILE", "DIR", "RASTER", "DEM", "OUT"})
            if (word.starts_with(kind)) return true;
    return false;
}

}  // namespace ridgeline::app
