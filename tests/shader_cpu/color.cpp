#include "ridgeline/shaders/lib/color.h"

#include <doctest/doctest.h>

#include <cmath>

namespace ridgeline::shaders {
namespace {

TEST_CASE("sRGB to linear and back is the identity for every 8-bit value") {
    for (int value = 0; value < 256; ++value) {
        const float srgb = static_cast<float>(value) / 255.0f;
        CHECK(std::lround(srgb_from_linear(linear_from_srgb(srgb)) * 255.0f) == value);
    }
}

TEST_CASE("the transfer function matches the standard in double precision") {
    for (int i = 0; i <= 1000; ++i) {
        const double srgb = i / 1000.0;
        const double linear = srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
        CHECK(std::abs(double{linear_from_srgb(static_cast<float>(srgb))} - linear) < 1e-6);
    }
}

TEST_CASE("white has luminance 1") { CHECK(luminance(vec3(1.0f)) == doctest::Approx(1.0)); }

}  // namespace
}  // namespace ridgeline::shaders
