#include "support/sealed_json.h"

#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "ridgeline/base/json_text.h"
#include "ridgeline/io/store.h"

namespace ridgeline::test {

std::optional<std::string> sealed(std::string_view text) {
    nlohmann::json json = parse_json(text);
    if (!json.is_object()) return {};
    json.erase("checksum");
    const std::string canonical = json_text(json);
    const unsigned long long hash =
        io::payload_checksum({reinterpret_cast<const std::uint8_t*>(canonical.data()), canonical.size()});
    std::array<char, 17> digits{};
    std::snprintf(digits.data(), digits.size(), "%016llx", hash);
    json["checksum"] = digits.data();
    return json_text(json);
}

}  // namespace ridgeline::test
