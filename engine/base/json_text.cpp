#include "ridgeline/base/json_text.h"

#include <nlohmann/json.hpp>

namespace ridgeline {
namespace {

template <class Json>
std::string written(const Json& value, int indent) {
    return value.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

std::string json_text(const nlohmann::json& value, int indent) { return written(value, indent); }
std::string json_text(const nlohmann::ordered_json& value, int indent) { return written(value, indent); }
std::string json_text(std::string_view text) { return written(nlohmann::json(text), -1); }
std::string json_text(double number) { return written(nlohmann::json(number), -1); }

nlohmann::json parse_json(std::string_view text) { return nlohmann::json::parse(text, nullptr, false); }

}  // namespace ridgeline
