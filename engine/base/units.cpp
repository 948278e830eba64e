#include "ridgeline/base/units.h"

#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace ridgeline {

Result<std::uint64_t> parse_bytes(std::string_view text) {
    const Error wrong{"'" + std::string(text) + "' is not a size: write it like 256MiB or 1GiB"};
    double number = 0.0;
    const auto [rest, status] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (status != std::errc() || !std::isfinite(number) || number < 0.0) return wrong;
    const std::string_view unit(rest, static_cast<std::size_t>(text.data() + text.size() - rest));
    double scale = 0.0;
    if (unit.empty() || unit == "B") scale = 1.0;
    if (unit == "K" || unit == "KiB") scale = 0x1p10;
    if (unit == "M" || unit == "MiB") scale = 0x1p20;
    if (unit == "G" || unit == "GiB") scale = 0x1p30;
    if (unit == "T" || unit == "TiB") scale = 0x1p40;
    if (scale == 0.0 || number * scale >= 0x1p62) return wrong;
    return static_cast<std::uint64_t>(number * scale);
}

std::string format_bytes(std::uint64_t bytes) {
    constexpr std::array<const char*, 5> kUnits = {"B", "KiB", "MiB", "GiB", "TiB"};
    double amount = static_cast<double>(bytes);
    std::size_t unit = 0;
    for (; amount >= 1024.0 && unit + 1 < kUnits.size(); ++unit) amount /= 1024.0;
    char text[32];
    std::snprintf(text, sizeof text, unit == 0 ? "%.0f %s" : "%.1f %s", amount, kUnits[unit]);
    return text;
}

std::string counted(std::int64_t count, std::string_view noun) {
    std::string text = std::to_string(count) + ' ';
    text += noun;
    if (count != 1) text += 's';
    return text;
}

}  // namespace ridgeline
