#include "ridgeline/app/report/quantity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>

#include "ridgeline/base/units.h"

namespace ridgeline::app::report {
namespace {

std::string printed(const char* format, double value) {
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), format, value);
    return text.data();
}

// A fraction without the zeros at its end.
std::string trimmed(std::string text) {
    if (text.find('.') == std::string::npos) return text;
    text.erase(text.find_last_not_of('0') + 1);
    if (text.ends_with('.')) text.pop_back();
    return text;
}

// Whole, in groups of three with a narrow space that does not break.
std::string grouped(double value) {
    std::string text = printed("%.0f", value);
    const std::size_t sign = text.starts_with('-') ? 1 : 0;
    for (std::size_t at = text.size(); at > sign + 3; at -= 3) text.insert(at - 3, "\xE2\x80\xAF");
    return text;
}

// To three digits, never with an exponent.
std::string three_digits(double value) {
    const double size = std::abs(value);
    if (size >= 999.5) return grouped(value);
    if (size == 0.0 || size < 0.0005) return "0";
    const int decimals = std::clamp(2 - static_cast<int>(std::floor(std::log10(size))), 0, 3);
    return printed(("%." + std::to_string(decimals) + "f").c_str(), value);
}

std::string bytes_text(double value) {
    const auto whole = static_cast<std::uint64_t>(std::clamp(value, 0.0, 0x1p62));
    return (value < 0.0 ? "-" : "") + format_bytes(whole);
}

// "64 MiB", for sizes that are whole in their unit.
std::string short_bytes(double value) {
    std::string text = bytes_text(value);
    if (const auto fraction = text.find(".0 "); fraction != std::string::npos) text.erase(fraction, 2);
    return text;
}

std::string short_count(double value) {
    const double size = std::abs(value);
    if (size >= 999.5e9) return printed("%.3g", value);
    if (size >= 999.5e6) return trimmed(three_digits(value * 1e-9)) + "G";
    if (size >= 999.5e3) return trimmed(three_digits(value * 1e-6)) + "M";
    if (size >= 1e4) return trimmed(three_digits(value * 1e-3)) + "k";
    return trimmed(printed("%.4f", value));
}

}  // namespace

std::string unit_name(Unit unit) {
    switch (unit) {
        case Unit::milliseconds:
            return "ms";
        case Unit::seconds:
            return "s";
        case Unit::metres:
            return "m";
        case Unit::percent:
            return "%";
        case Unit::frames:
            return "frames";
        case Unit::bytes:
        case Unit::count:
            return "";
    }
    return "";
}

std::string quantity(double value, Unit unit) {
    if (std::isnan(value)) return "–";
    if (unit == Unit::bytes) return bytes_text(value);
    const std::string number = value == std::floor(value) ? grouped(value) : three_digits(value);
    const std::string name = unit_name(unit);
    return name.empty() ? number : number + "\xE2\x80\xAF" + name;
}

std::string tick_text(double value, Unit unit) {
    if (std::isnan(value)) return "–";
    return unit == Unit::bytes ? short_bytes(value) : short_count(value);
}

std::string ratio_text(double value, double first) {
    if (std::isnan(value) || std::isnan(first)) return "–";
    if (value == first) return "=";
    if (first == 0.0 || value / first < 0.0) return "–";
    return "×" + three_digits(value / first);
}

}  // namespace ridgeline::app::report
