// Blocks of texels of every kind that pictures hold, for what encodes them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "ridgeline/build/imagery/texel_rows.h"

namespace ridgeline::test {

using TexelBlock = std::array<build::Texel, 16>;

enum class BlockKind { noise, one_colour, nearly_one, two_colours, gradient, grey, with_holes, empty };
constexpr int kBlockKinds = 8;

inline TexelBlock random_block(BlockKind kind, std::mt19937& random) {
    const auto byte = [&random](int least = 0, int most = 255) {
        return static_cast<std::uint8_t>(std::uniform_int_distribution<int>(least, most)(random));
    };
    const auto colour = [&] { return build::Texel{byte(), byte(), byte(), build::kOpaque}; };
    const build::Texel one = colour(), other = colour();
    const auto between = [&](double share) {
        const auto mix = [share](int a, int b) {
            return static_cast<std::uint8_t>(std::lround(a + share * (b - a)));
        };
        return build::Texel{mix(one.red, other.red), mix(one.green, other.green), mix(one.blue, other.blue),
                            build::kOpaque};
    };
    const auto near = [&](std::uint8_t value) {
        return static_cast<std::uint8_t>(std::clamp(value + byte(0, 6) - 3, 0, 255));
    };
    TexelBlock block;
    for (std::size_t i = 0; i < block.size(); ++i) switch (kind) {
            case BlockKind::noise:
                block[i] = colour();
                break;
            case BlockKind::one_colour:
                block[i] = one;
                break;
            case BlockKind::nearly_one:
                block[i] = {near(one.red), near(one.green), near(one.blue), build::kOpaque};
                break;
            case BlockKind::two_colours:
                block[i] = random() % 2 ? one : other;
                break;
            case BlockKind::gradient:
                block[i] = between(static_cast<double>(i % 4 + i / 4) / 6.0);
                break;
            case BlockKind::grey:
                block[i] = one;
                block[i].red = block[i].green = block[i].blue = near(one.red);
                break;
            case BlockKind::with_holes:
                block[i] = between(byte() / 255.0);
                if (random() % 3 == 0) block[i].alpha = 0;
                break;
            case BlockKind::empty:
                block[i] = {byte(), byte(), byte(), 0};
                break;
        }
    return block;
}

}  // namespace ridgeline::test
