// The words of the command line: sizes, colours, places and times as text, and the values they mean.
//
// Pure functions of their text, any thread. An Error is the WHY of a usage error ("'12' is not a size: …");
// the command line puts the option's name before it.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <variant>

#include "ridgeline/base/result.h"
#include "ridgeline/base/units.h"

namespace ridgeline::app {

// Both ends are allowed.
template <class T>
struct Range {
    T least;
    T most;
};

Result<double> parse_number(std::string_view text, Range<double> range);
// Above zero, and finite.
Result<double> parse_positive(std::string_view text);
Result<std::int64_t> parse_integer(std::string_view text, Range<std::int64_t> range);
// At least one byte.
Result<std::uint64_t> parse_capacity(std::string_view text);

// What a walk may hold of tiles, decoded in memory and on the GPU.
struct CacheSizes {
    std::uint64_t ram_bytes = 256_MiB;
    std::uint64_t gpu_bytes = 512_MiB;
};

// WIDTHxHEIGHT in pixels, 1 to 16384 each.
Result<glm::ivec2> parse_size(std::string_view text);

// RRGGBB, hexadecimal.
struct Colour {
    std::uint8_t red = 0, green = 0, blue = 0;
    friend bool operator==(const Colour&, const Colour&) = default;
};
Result<Colour> parse_colour(std::string_view text);

// EAST,NORTH.
Result<glm::dvec2> parse_place(std::string_view text);

// EPSG:n, returned in capitals.
Result<std::string> parse_crs(std::string_view text);

// FRAME:FILE.png; frames count from 0.
struct Shot {
    std::int64_t frame = 0;
    std::filesystem::path file;
};
Result<Shot> parse_shot(std::string_view text);

// A file, or one of the paths that Ridgeline lays itself. A file named "ground" is "./ground".
struct PathChoice {
    enum class Kind { orbit, ground, file };
    Kind kind = Kind::orbit;
    std::filesystem::path file;
};
Result<PathChoice> parse_path_choice(std::string_view text);

// Where the sun stands, or when: the place is then the dataset's.
struct SunDirection {
    Angle azimuth;    // clockwise from north
    Angle elevation;  // up from level
};
using SunChoice = std::variant<SunDirection, std::chrono::sys_seconds>;
// AZIMUTH,ELEVATION in degrees, or a time in UTC: 2026-06-21T09:00Z, seconds allowed.
Result<SunChoice> parse_sun(std::string_view text);

}  // namespace ridgeline::app
