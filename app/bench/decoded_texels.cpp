#include "ridgeline/app/bench/decoded_texels.h"

#include <algorithm>
#include <cmath>

namespace ridgeline::app {

using build::Texel;

Result<std::unique_ptr<DecodedTexels>> DecodedTexels::read_from(build::TexelRows& rows,
                                                                std::int64_t most_texels) {
    auto decoded = std::make_unique<DecodedTexels>();
    decoded->info_ = rows.info();
    const std::int64_t width = rows.info().width;
    decoded->info_.height = std::min(rows.info().height, std::max<std::int64_t>(most_texels / width, 1));
    decoded->texels_.resize(static_cast<std::size_t>(decoded->count()));
    // As many at once as a row of tiles takes.
    for (std::int64_t row = 0; row < decoded->info_.height; row += io::kImageryTile) {
        const std::int64_t count = std::min<std::int64_t>(io::kImageryTile, decoded->info_.height - row);
        const auto texels = std::span(decoded->texels_)
                                .subspan(static_cast<std::size_t>(row * width),
                                         static_cast<std::size_t>(count * width));
        RIDGELINE_TRY(rows.read(row, count, texels));
    }
    return decoded;
}

Result<void> DecodedTexels::read(std::int64_t row, std::int64_t rows, std::span<Texel> texels) {
    std::copy_n(&at(0, row), rows * info_.width, texels.begin());
    return {};
}

// Khronos Data Format Specification, 18.1 and 18.2.
build::BlockTexels shown_texels(const io::Bc1Block& block) {
    const auto widened = [](std::uint16_t c) {
        const int red = c >> 11, green = c >> 5 & 63, blue = c & 31;
        return std::array{red << 3 | red >> 2, green << 2 | green >> 4, blue << 3 | blue >> 2};
    };
    const auto first = widened(block.first), second = widened(block.second);
    const bool three = block.first <= block.second;
    const auto mixed = [&](int of_first, int of_second) {
        std::array<std::uint8_t, 3> c;
        for (std::size_t i = 0; i < c.size(); ++i)
            c[i] = static_cast<std::uint8_t>((of_first * first[i] + of_second * second[i]) /
                                             (of_first + of_second));
        return Texel{c[0], c[1], c[2], build::kOpaque};
    };
    const std::array<Texel, 4> palette = {mixed(1, 0), mixed(0, 1), three ? mixed(1, 1) : mixed(2, 1),
                                          three ? Texel{} : mixed(1, 2)};
    build::BlockTexels texels;
    for (std::size_t i = 0; i < texels.size(); ++i) texels[i] = palette[block.indices >> (2 * i) & 3u];
    return texels;
}

void SquaredErrors::add(const Texel& is, const Texel& shown) {
    if (is.alpha == 0 || shown.alpha == 0) return;
    const double red = is.red - shown.red, green = is.green - shown.green, blue = is.blue - shown.blue;
    squares_ += red * red + green * green + blue * blue;
    ++texels_;
}

double SquaredErrors::psnr_db() const {
    return 10.0 * std::log10(255.0 * 255.0 * 3.0 * static_cast<double>(texels_) / squares_);
}

}  // namespace ridgeline::app
