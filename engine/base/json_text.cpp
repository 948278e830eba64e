#include "ridgeline/base/json_text.h"

#include <nlohmann/json.hpp>
#include <utility>

namespace ridgeline {
namespace {

// nlohmann copies and writes by recursion, so that a file of brackets would overflow the stack. Files of ours
// nest five deep.
constexpr int kMostNesting = 32;

template <class Json>
std::string written(const Json& value, int indent) {
    return value.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

std::string json_text(const nlohmann::json& value, int indent) { return written(value, indent); }
std::string json_text(const nlohmann::ordered_json& value, int indent) { return written(value, indent); }
std::string json_text(std::string_view text) { return written(nlohmann::json(text), -1); }
std::string json_text(double number) { return written(nlohmann::json(number), -1); }

nlohmann::json parse_json(std::string_view text) {
    using Json = nlohmann::json;
    bool too_deep = false;
    const auto watch = [&too_deep](int depth, Json::parse_event_t, Json&) {
        too_deep = too_deep || depth > kMostNesting;
        return !too_deep;
    };
    Json value = Json::parse(text, watch, false);
    return too_deep ? Json(Json::value_t::discarded) : std::move(value);
}

}  // namespace ridgeline
