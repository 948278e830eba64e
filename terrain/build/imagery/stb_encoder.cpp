// F. Giesen's stb_dxt fits endpoints along the principal axis and refines them by least squares; it knows no
// transparent texels. Blocks that have some are fitted with the mean of the others in their place, and then go
// from four colours to the three that leave an index for transparency.
#include <algorithm>
#include <array>
#include <cstring>

#include "ridgeline/build/imagery/image_encoder.h"

#define STB_DXT_STATIC
#define STB_DXT_IMPLEMENTATION
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_dxt.h>
#pragma GCC diagnostic pop

namespace ridgeline::build {
namespace {

io::Bc1Block fit(const BlockTexels& texels) {
    std::array<unsigned char, sizeof(io::Bc1Block)> bytes;
    stb_compress_dxt_block(bytes.data(), reinterpret_cast<const unsigned char*>(texels.data()), 0,
                           STB_DXT_HIGHQUAL);
    io::Bc1Block block;
    std::memcpy(&block, bytes.data(), sizeof block);
    return block;
}

struct Colour {
    int red = 0, green = 0, blue = 0;
};

// As the hardware widens it: high bits repeat below.
Colour widened(std::uint16_t endpoint) {
    const int red = endpoint >> 11, green = endpoint >> 5 & 63, blue = endpoint & 31;
    return {red << 3 | red >> 2, green << 2 | green >> 4, blue << 3 | blue >> 2};
}

int distance(const Texel& texel, const Colour& colour) {
    const int red = texel.red - colour.red, green = texel.green - colour.green,
              blue = texel.blue - colour.blue;
    return red * red + green * green + blue * blue;
}

// Index 3 where transparent, else the nearest of the three colours.
std::uint32_t indices_with_holes(const BlockTexels& texels, Colour first, Colour second) {
    const Colour middle{(first.red + second.red) / 2, (first.green + second.green) / 2,
                        (first.blue + second.blue) / 2};
    std::uint32_t indices = 0;
    for (std::size_t i = 0; i < texels.size(); ++i) {
        std::uint32_t index = 3;
        if (texels[i].alpha != 0) {
            const std::array distances = {distance(texels[i], first), distance(texels[i], second),
                                          distance(texels[i], middle)};
            index = static_cast<std::uint32_t>(std::min_element(distances.begin(), distances.end()) -
                                               distances.begin());
        }
        indices |= index << (2 * i);
    }
    return indices;
}

Texel mean_of_opaque(const BlockTexels& texels, int count) {
    int red = count / 2, green = count / 2, blue = count / 2;
    for (const Texel& texel : texels) {
        if (texel.alpha == 0) continue;
        red += texel.red, green += texel.green, blue += texel.blue;
    }
    const auto mean = [count](int sum) { return static_cast<std::uint8_t>(sum / count); };
    return {mean(red), mean(green), mean(blue), kOpaque};
}

io::Bc1Block fit_with_holes(const BlockTexels& texels, int opaque) {
    constexpr io::Bc1Block kNothing{0, 0, ~0u};
    if (opaque == 0) return kNothing;
    BlockTexels filled = texels;
    const Texel mean = mean_of_opaque(texels, opaque);
    for (Texel& texel : filled)
        if (texel.alpha == 0) texel = mean;
    io::Bc1Block block = fit(filled);
    if (block.first > block.second) std::swap(block.first, block.second);
    block.indices = indices_with_holes(texels, widened(block.first), widened(block.second));
    return block;
}

class StbEncoder final : public ImageEncoder {
  public:
    void encode(std::span<const TexelSquare> squares, Done done) override {
        for (const TexelSquare& square : squares)
            for_each_block(square, [](const BlockTexels& texels, io::Bc1Block& block) {
                block = encode_on_cpu(texels);
            });
        done({});
    }
    int tiles_under_way(int threads) const override { return threads; }
    std::uint64_t memory_bytes() const override { return 0; }
};

}  // namespace

io::Bc1Block encode_on_cpu(const BlockTexels& texels) {
    const auto opaque =
        std::count_if(texels.begin(), texels.end(), [](const Texel& t) { return t.alpha != 0; });
    return opaque == std::ssize(texels) ? fit(texels) : fit_with_holes(texels, static_cast<int>(opaque));
}

std::unique_ptr<ImageEncoder> make_cpu_encoder() { return std::make_unique<StbEncoder>(); }

}  // namespace ridgeline::build
