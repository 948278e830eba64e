// Quantities that are easily mixed up: angles as a type, sizes in bytes as text and back.
#pragma once

#include <cstdint>
#include <numbers>
#include <string>
#include <string_view>

#include "ridgeline/base/result.h"

namespace ridgeline {

// An angle; made from and read in the unit that is named.
class Angle {
  public:
    constexpr Angle() = default;
    static constexpr Angle from_degrees(double degrees) { return Angle(degrees * std::numbers::pi / 180.0); }
    static constexpr Angle from_radians(double radians) { return Angle(radians); }
    constexpr double degrees() const { return radians_ * 180.0 / std::numbers::pi; }
    constexpr double radians() const { return radians_; }

    friend constexpr Angle operator+(Angle a, Angle b) { return Angle(a.radians_ + b.radians_); }
    friend constexpr Angle operator-(Angle a, Angle b) { return Angle(a.radians_ - b.radians_); }
    friend constexpr Angle operator*(Angle a, double factor) { return Angle(a.radians_ * factor); }
    friend constexpr auto operator<=>(Angle, Angle) = default;

  private:
    explicit constexpr Angle(double radians) : radians_(radians) {}
    double radians_ = 0.0;
};

constexpr std::uint64_t operator""_KiB(unsigned long long n) { return n << 10; }
constexpr std::uint64_t operator""_MiB(unsigned long long n) { return n << 20; }
constexpr std::uint64_t operator""_GiB(unsigned long long n) { return n << 30; }

// "256MiB", "1GiB", "64KiB", "4096" or "512M"/"2G" (read as binary) to bytes; fractions are allowed.
Result<std::uint64_t> parse_bytes(std::string_view text);
// "256.0 MiB".
std::string format_bytes(std::uint64_t bytes);

// "1 tile", "12 tiles": a count and the noun that it counts, which takes an s where they are several.
std::string counted(std::int64_t count, std::string_view noun);

}  // namespace ridgeline
