// Blocks of texels of every kind that an encoder meets: noise, gradients, edges, nearly one colour, holes.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include "ridgeline/build/imagery/image_encoder.h"
#include "ridgeline/shaders/shared/bc1_blocks.h"
#include "support/bc1.h"

namespace ridgeline::test {

enum class BlockKind { noise, gradient, edge, faint, mountain };
constexpr BlockKind kBlockKinds[] = {BlockKind::noise, BlockKind::gradient, BlockKind::edge, BlockKind::faint,
                                     BlockKind::mountain};

class RandomBlocks {
  public:
    explicit RandomBlocks(std::uint32_t seed) : random_(seed) {}

    build::BlockTexels next(BlockKind kind) {
        const Colour a = colour(), b = colour(), c = colour();
        build::BlockTexels texels;
        for (std::size_t i = 0; i < texels.size(); ++i) {
            const double x = static_cast<double>(i % 4) / 3.0, y = static_cast<double>(i / 4) / 3.0;
            texels[i] = kind == BlockKind::noise      ? texel(colour())
                        : kind == BlockKind::gradient ? texel(a * (x * (1.0 - y)) + b * (y * 0.7) + c * 0.3)
                        : kind == BlockKind::edge     ? texel(x + 0.6 * y > share_ ? a : b)
                        : kind == BlockKind::faint    ? texel(a + colour() * (6.0 / 255.0))
                                                      : texel((a * 0.5 + c * 0.2) * (0.8 + 0.4 * unit()));
        }
        share_ = unit() * 1.6;
        return texels;
    }
    // Some, all or none.
    void pierce(build::BlockTexels& texels) {
        const double share = unit() * 1.2;
        for (build::Texel& texel : texels)
            if (unit() < share) texel.alpha = 0;
    }
    build::Texel any_texel() { return texel(colour()); }

  private:
    struct Colour {
        double red, green, blue;
        Colour operator*(double s) const { return {red * s, green * s, blue * s}; }
        Colour operator+(const Colour& o) const { return {red + o.red, green + o.green, blue + o.blue}; }
    };
    double unit() { return std::uniform_real_distribution<double>(0.0, 1.0)(random_); }
    Colour colour() { return {255.0 * unit(), 255.0 * unit(), 255.0 * unit()}; }
    static build::Texel texel(const Colour& c) {
        const auto byte = [](double v) {
            return static_cast<std::uint8_t>(std::lround(std::clamp(v, 0.0, 255.0)));
        };
        return {byte(c.red), byte(c.green), byte(c.blue), build::kOpaque};
    }

    std::mt19937 random_;
    double share_ = 0.7;
};

inline shaders::Bc1Texels shader_texels(const build::BlockTexels& texels) {
    shaders::Bc1Texels words;
    static_assert(sizeof words == sizeof texels);
    std::memcpy(&words, texels.data(), sizeof words);
    return words;
}

inline double squares_between(const build::Texel& a, const build::Texel& b) {
    const double red = a.red - b.red, green = a.green - b.green, blue = a.blue - b.blue;
    return red * red + green * green + blue * blue;
}

// Over opaque texels, as the hardware shows the block.
inline double squared_error(const build::BlockTexels& texels, const io::Bc1Block& block) {
    double squares = 0.0;
    for (std::size_t i = 0; i < texels.size(); ++i)
        if (texels[i].alpha != 0)
            squares += squares_between(texels[i], texel_of_block(block, static_cast<int>(i)));
    return squares;
}

}  // namespace ridgeline::test
