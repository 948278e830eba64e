// JSON to text and back. nlohmann's writer and parser take seconds to compile: here they do once, and whoever
// makes or reads values includes <nlohmann/json.hpp> for those alone. Pure functions, any thread.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace ridgeline {

// `indent`: spaces a level; negative: all on one line. Names of files need not be UTF-8, but JSON must be:
// what is not becomes U+FFFD.
std::string json_text(const nlohmann::json& value, int indent = -1);
std::string json_text(const nlohmann::ordered_json& value, int indent = -1);
// In quotes.
std::string json_text(std::string_view text);
// As short as it reads back; "null" where it is not finite.
std::string json_text(double number);

// What is not JSON, or nests deeper than any file of ours, gives a value that is_discarded().
nlohmann::json parse_json(std::string_view text);

}  // namespace ridgeline
