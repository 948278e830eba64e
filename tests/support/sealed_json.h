// terrain.json with a checksum that fits, whatever else it says: what lies behind the checksum is reached by
// damage that whoever made it sealed.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace ridgeline::test {

// None: the text is no JSON object.
std::optional<std::string> sealed(std::string_view text);

}  // namespace ridgeline::test
