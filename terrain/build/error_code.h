// Vertical errors as 8-bit logarithmic codes: eight steps an octave, monotone, so that they can be compared
// and maximised as they stand.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace ridgeline::build {

constexpr int kErrorCodes = 256;

namespace detail {
// A float's exponent and three leading mantissa bits, counted so that 1.0 becomes 1.
constexpr int kMantissaShift = 20;
constexpr std::int32_t kCodeBias = 127 * 8 - 1;
// A square has half as many steps to its octave.
constexpr std::int32_t kSquareBias = 127 * 4 - 1;
}  // namespace detail

// Of a vertex of height v that halves the hypotenuse from a to b: |v - (a + b) / 2|; code 0 means none at
// all.
inline std::uint8_t error_code(std::int32_t v, std::int32_t a, std::int32_t b) {
    const auto doubled = static_cast<float>(std::abs(2 * v - a - b));
    const std::int32_t code =
        (std::bit_cast<std::int32_t>(doubled) >> detail::kMantissaShift) - detail::kCodeBias;
    return static_cast<std::uint8_t>(std::max(code, 0));
}

// The same of a height whose square is known, in half quanta, as cones give it: monotone too, with steps of
// the square's two leading mantissa bits.
inline std::uint8_t error_code_of_square(float doubled_squared) {
    const std::int32_t code =
        (std::bit_cast<std::int32_t>(doubled_squared) >> (detail::kMantissaShift + 1)) - detail::kSquareBias;
    return static_cast<std::uint8_t>(std::clamp(code, 0, kErrorCodes - 1));
}

// The largest error that has this code or a lesser one, in quanta.
inline double largest_error(std::uint8_t code) {
    if (code == 0) return 0.0;
    const auto next = std::bit_cast<float>((code + 1 + detail::kCodeBias) << detail::kMantissaShift);
    return 0.5 * (std::ceil(static_cast<double>(next)) - 1.0);
}

// The bound of what error_code_of_square gives this code or a lesser one, in quanta.
inline double largest_error_of_square(std::uint8_t code) {
    const auto next = std::bit_cast<float>((code + 1 + detail::kSquareBias) << (detail::kMantissaShift + 1));
    return 0.5 * std::sqrt(static_cast<double>(next));
}

}  // namespace ridgeline::build
