// F. Giesen's stb_dxt fits endpoints along the principal axis and refines them by least squares; it knows no
// transparent texels. Blocks that have some are fitted with the mean of the others in their place, and then
// go from four colours to the three that leave an index for transparency.
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

constexpr std::size_t kBlockTexels = 16;
using Block = std::array<Texel, kBlockTexels>;

io::Bc1Block fit(const Block& texels) {
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
std::uint32_t indices_with_holes(const Block& texels, Colour first, Colour second) {
    const Colour middle{(first.red + second.red) / 2, (first.green + second.green) / 2,
                        (first.blue + second.blue) / 2};
    std::uint32_t indices = 0;
    for (std::size_t i = 0; i < kBlockTexels; ++i) {
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

Texel mean_of_opaque(const Block& texels, int count) {
    int red = count / 2, green = count / 2, blue = count / 2;
    for (const Texel& texel : texels) {
        if (texel.alpha == 0) continue;
        red += texel.red, green += texel.green, blue += texel.blue;
    }
    const auto mean = [count](int sum) { return static_cast<std::uint8_t>(sum / count); };
    return {mean(red), mean(green), mean(blue), kOpaque};
}

io::Bc1Block fit_with_holes(const Block& texels, int opaque) {
    constexpr io::Bc1Block kNothing{0, 0, ~0u};
    if (opaque == 0) return kNothing;
    Block filled = texels;
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
    Result<void> encode(std::span<const Texel> texels, int side, std::span<io::Bc1Block> blocks) override {
        const auto stride = static_cast<std::size_t>(side), across = stride / 4;
        RIDGELINE_CHECK(side % 4 == 0 && texels.size() == stride * stride &&
                        blocks.size() == across * across);
        for (std::size_t row = 0; row < across; ++row)
            for (std::size_t column = 0; column < across; ++column)
                blocks[row * across + column] = encode(&texels[row * 4 * stride + column * 4], stride);
        return {};
    }

  private:
    static io::Bc1Block encode(const Texel* corner, std::size_t stride) {
        Block texels;
        for (std::size_t row = 0; row < 4; ++row)
            std::copy_n(corner + row * stride, 4, texels.begin() + static_cast<std::ptrdiff_t>(row * 4));
        const auto opaque =
            std::count_if(texels.begin(), texels.end(), [](const Texel& t) { return t.alpha != 0; });
        return opaque == kBlockTexels ? fit(texels) : fit_with_holes(texels, static_cast<int>(opaque));
    }
};

}  // namespace

std::unique_ptr<ImageEncoder> make_cpu_encoder() { return std::make_unique<StbEncoder>(); }

}  // namespace ridgeline::build
