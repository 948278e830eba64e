// Text for HTML: whatever comes from telemetry or the file system passes through here before it reaches the
// page. Pure functions, any thread.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace ridgeline::app::report {

// Safe between tags and in quoted attributes: what HTML reads as markup is written as entities; control
// characters, and bytes that are no UTF-8, become U+FFFD.
std::string escaped(std::string_view text);

// The same, set apart from the text around it: a name in a script from right to left, or full of marks that
// turn the direction, cannot reorder the page.
std::string isolated(std::string_view text);

std::string base64(std::span<const std::byte> bytes);

}  // namespace ridgeline::app::report
