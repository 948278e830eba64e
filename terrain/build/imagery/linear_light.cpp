// IEC 61966-2-1 has the curve. Linear values have 16 bits: the darkest step of sRGB's eight is twenty of
// them.
#include "ridgeline/build/imagery/linear_light.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "ridgeline/base/contract.h"

namespace ridgeline::build {
namespace {

constexpr int kLinearMax = 65535;

double linear_of(double coded) {
    return coded <= 0.04045 ? coded / 12.92 : std::pow((coded + 0.055) / 1.055, 2.4);
}
double coded_of(double linear) {
    return linear <= 0.0031308 ? linear * 12.92 : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

struct Curves {
    std::array<std::uint16_t, 256> linear;
    std::vector<std::uint8_t> coded;  // by linear value

    Curves() : coded(kLinearMax + 1) {
        for (std::size_t i = 0; i < linear.size(); ++i)
            linear[i] = static_cast<std::uint16_t>(
                std::lround(linear_of(static_cast<double>(i) / 255.0) * kLinearMax));
        for (std::size_t i = 0; i < coded.size(); ++i)
            coded[i] =
                static_cast<std::uint8_t>(std::lround(coded_of(static_cast<double>(i) / kLinearMax) * 255.0));
    }
};

const Curves& curves() {
    static const Curves made;
    return made;
}

std::uint8_t mean_of_four(const Curves& c, std::uint8_t a, std::uint8_t b, std::uint8_t d, std::uint8_t e) {
    const std::uint32_t sum = std::uint32_t{c.linear[a]} + c.linear[b] + c.linear[d] + c.linear[e];
    return c.coded[(sum + 2) / 4];
}

Texel mean_of_some(const Curves& c, const std::array<Texel, 4>& texels) {
    std::uint32_t red = 0, green = 0, blue = 0, count = 0;
    for (const Texel& texel : texels) {
        if (texel.alpha == 0) continue;
        red += c.linear[texel.red], green += c.linear[texel.green], blue += c.linear[texel.blue];
        ++count;
    }
    if (count == 0) return {};
    const auto mean = [&](std::uint32_t sum) { return c.coded[(sum + count / 2) / count]; };
    return {mean(red), mean(green), mean(blue), kOpaque};
}

}  // namespace

void halve(std::span<const Texel> from, int side, std::span<Texel> to) {
    const auto stride = static_cast<std::size_t>(side), half = stride / 2;
    RIDGELINE_CHECK(side % 2 == 0 && from.size() == stride * stride && to.size() == half * half);
    const Curves& c = curves();
    for (std::size_t row = 0; row < half; ++row)
        for (std::size_t column = 0; column < half; ++column) {
            const Texel* at = &from[2 * row * stride + 2 * column];
            const Texel &a = at[0], &b = at[1], &d = at[stride], &e = at[stride + 1];
            const bool opaque = (a.alpha & b.alpha & d.alpha & e.alpha) != 0;
            to[row * half + column] = opaque ? Texel{mean_of_four(c, a.red, b.red, d.red, e.red),
                                                     mean_of_four(c, a.green, b.green, d.green, e.green),
                                                     mean_of_four(c, a.blue, b.blue, d.blue, e.blue), kOpaque}
                                             : mean_of_some(c, {a, b, d, e});
        }
}

}  // namespace ridgeline::build
