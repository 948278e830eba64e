#include "ridgeline/app/options.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <vector>

namespace ridgeline::app {
namespace {

std::string quoted(std::string_view text) { return "'" + std::string(text) + "'"; }

// All of `text` as a number, or nothing.
template <class T>
std::optional<T> whole_number(std::string_view text) {
    T value{};
    const char* end = text.data() + text.size();
    const auto [rest, status] = std::from_chars(text.data(), end, value);
    if (text.empty() || status != std::errc() || rest != end) return std::nullopt;
    return value;
}

std::optional<double> finite_number(std::string_view text) {
    const auto value = whole_number<double>(text);
    return value && std::isfinite(*value) ? value : std::nullopt;
}

std::string shown(double value) {
    std::array<char, 32> text{};
    const auto [end, status] = std::to_chars(text.data(), text.data() + text.size(), value);
    return status == std::errc() ? std::string(text.data(), end) : std::to_string(value);
}

std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> parts;
    for (std::size_t at = 0; at != std::string_view::npos;) {
        parts.push_back(text.substr(0, at = text.find(separator)));
        if (at != std::string_view::npos) text.remove_prefix(at + 1);
    }
    return parts;
}

bool all_digits(std::string_view text) {
    return !text.empty() &&
           std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

bool same_ignoring_case(std::string_view a, std::string_view b) {
    const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [&](char x, char y) { return lower(x) == lower(y); });
}

// Two finite numbers with a comma between them.
std::optional<glm::dvec2> number_pair(std::string_view text) {
    const auto parts = split(text, ',');
    if (parts.size() != 2) return std::nullopt;
    const auto first = finite_number(parts[0]);
    const auto second = finite_number(parts[1]);
    if (!first || !second) return std::nullopt;
    return glm::dvec2(*first, *second);
}

// A field of fixed width at `at`, digits only.
std::optional<int> digits_at(std::string_view text, std::size_t at, std::size_t count) {
    if (at + count > text.size() || !all_digits(text.substr(at, count))) return std::nullopt;
    return whole_number<int>(text.substr(at, count));
}

// YYYY-MM-DDThh:mm[:ss]Z.
std::optional<std::chrono::sys_seconds> utc_time(std::string_view text) {
    const bool with_seconds = text.size() == 20;
    if ((!with_seconds && text.size() != 17) || text.back() != 'Z') return std::nullopt;
    if (text[4] != '-' || text[7] != '-' || text[10] != 'T' || text[13] != ':') return std::nullopt;
    if (with_seconds && text[16] != ':') return std::nullopt;
    const auto year = digits_at(text, 0, 4), month = digits_at(text, 5, 2), day = digits_at(text, 8, 2);
    const auto hour = digits_at(text, 11, 2), minute = digits_at(text, 14, 2);
    const auto second = with_seconds ? digits_at(text, 17, 2) : 0;
    if (!year || !month || !day || !hour || !minute || !second) return std::nullopt;
    const std::chrono::year_month_day date(std::chrono::year{*year}, std::chrono::month(unsigned(*month)),
                                           std::chrono::day(unsigned(*day)));
    if (!date.ok() || *hour > 23 || *minute > 59 || *second > 59) return std::nullopt;
    return std::chrono::sys_days(date) + std::chrono::hours(*hour) + std::chrono::minutes(*minute) +
           std::chrono::seconds(*second);
}

}  // namespace

Result<double> parse_number(std::string_view text, Range<double> range) {
    const auto value = finite_number(text);
    if (!value) return Error{quoted(text) + " is not a number"};
    if (*value < range.least || *value > range.most)
        return Error{std::string(text) + " is out of range: use " + shown(range.least) + " to " +
                     shown(range.most)};
    return *value;
}

Result<double> parse_positive(std::string_view text) {
    const auto value = finite_number(text);
    if (!value || *value <= 0.0) return Error{quoted(text) + " is not a number above 0"};
    return *value;
}

Result<std::int64_t> parse_integer(std::string_view text, Range<std::int64_t> range) {
    const auto value = whole_number<std::int64_t>(text);
    if (!value) return Error{quoted(text) + " is not a whole number"};
    if (*value < range.least || *value > range.most)
        return Error{std::string(text) + " is out of range: use " + std::to_string(range.least) + " to " +
                     std::to_string(range.most)};
    return *value;
}

Result<std::uint64_t> parse_capacity(std::string_view text) {
    auto bytes = parse_bytes(text);
    if (bytes && *bytes == 0) return Error{quoted(text) + " is no room at all: write it like 256MiB or 1GiB"};
    return bytes;
}

Result<glm::ivec2> parse_size(std::string_view text) {
    constexpr int kMost_px = 16384;  // the least maximum texture size of current GPUs' drivers
    const auto parts = split(text, 'x');
    const auto width = parts.size() == 2 ? whole_number<int>(parts[0]) : std::nullopt;
    const auto height = parts.size() == 2 ? whole_number<int>(parts[1]) : std::nullopt;
    if (!width || !height) return Error{quoted(text) + " is not a size: write it like 1024x768"};
    if (std::min(*width, *height) < 1 || std::max(*width, *height) > kMost_px)
        return Error{std::string(text) + " is out of range: use 1 to " + std::to_string(kMost_px) +
                     " pixels a side"};
    return glm::ivec2(*width, *height);
}

Result<Colour> parse_colour(std::string_view text) {
    std::uint32_t rgb = 0;
    const auto [rest, status] = std::from_chars(text.data(), text.data() + text.size(), rgb, 16);
    if (text.size() != 6 || status != std::errc() || rest != text.data() + text.size())
        return Error{quoted(text) + " is not a colour: write six hexadecimal digits like FF00FF"};
    return Colour{static_cast<std::uint8_t>(rgb >> 16), static_cast<std::uint8_t>(rgb >> 8 & 0xff),
                  static_cast<std::uint8_t>(rgb & 0xff)};
}

Result<glm::dvec2> parse_place(std::string_view text) {
    const auto place = number_pair(text);
    if (!place) return Error{quoted(text) + " is not a place: write it as EAST,NORTH"};
    return *place;
}

Result<std::string> parse_crs(std::string_view text) {
    const auto parts = split(text, ':');
    if (parts.size() != 2 || !same_ignoring_case(parts[0], "EPSG") || !all_digits(parts[1]))
        return Error{quoted(text) + " is not a coordinate system: write it like EPSG:32633"};
    return "EPSG:" + std::string(parts[1]);
}

Result<Shot> parse_shot(std::string_view text) {
    const auto colon = text.find(':');
    const auto frame = whole_number<std::int64_t>(text.substr(0, colon));
    if (colon == std::string_view::npos || !frame || *frame < 0)
        return Error{quoted(text) + " is not a shot: write it as FRAME:FILE.png, frames from 0"};
    Shot shot{*frame, std::filesystem::path(text.substr(colon + 1))};
    if (!same_ignoring_case(shot.file.extension().string(), ".png"))
        return Error{quoted(text.substr(colon + 1)) + " does not end in .png"};
    return shot;
}

Result<PathChoice> parse_path_choice(std::string_view text) {
    if (text.empty()) return Error{"'' is no path: use ground, orbit or a file"};
    if (text == "orbit") return PathChoice{PathChoice::Kind::orbit, {}};
    if (text == "ground") return PathChoice{PathChoice::Kind::ground, {}};
    return PathChoice{PathChoice::Kind::file, std::filesystem::path(text)};
}

Result<SunChoice> parse_sun(std::string_view text) {
    if (const auto time = utc_time(text)) return SunChoice(*time);
    const auto degrees = number_pair(text);
    if (!degrees)
        return Error{quoted(text) +
                     " is no sun: write AZIMUTH,ELEVATION in degrees or a time like 2026-06-21T09:00Z"};
    if (std::abs(degrees->x) > 360.0 || std::abs(degrees->y) > 90.0)
        return Error{std::string(text) +
                     " is out of range: use an azimuth to 360 and an elevation of -90 to 90 degrees"};
    return SunChoice(SunDirection{Angle::from_degrees(degrees->x), Angle::from_degrees(degrees->y)});
}

}  // namespace ridgeline::app
