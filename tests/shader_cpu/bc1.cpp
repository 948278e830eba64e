// The GPU's BC1 encoder, run on the CPU: the very text that the GPU runs.
#include "ridgeline/shaders/lib/bc1.h"

#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <cstring>

#include "ridgeline/build/imagery/image_encoder.h"
#include "support/bc1.h"
#include "support/texel_blocks.h"

using namespace ridgeline;
using namespace ridgeline::test;

namespace {

io::Bc1Block encoded(const TexelBlock& texels) {
    shaders::Bc1Texels packed;
    static_assert(sizeof packed == sizeof(TexelBlock));
    std::memcpy(&packed, texels.data(), sizeof packed);
    return std::bit_cast<io::Bc1Block>(shaders::bc1_encoded(packed));
}

io::Bc1Block encoded_by_stb(const TexelBlock& texels) {
    static const auto encoder = build::make_cpu_encoder();
    io::Bc1Block block;
    REQUIRE(encoder->encode(texels, 4, std::span(&block, 1)));
    return block;
}

// Over the opaque texels; transparent ones must be so.
double squared_error(const TexelBlock& texels, const io::Bc1Block& block) {
    double sum = 0.0;
    for (std::size_t i = 0; i < texels.size(); ++i) {
        const build::Texel shown = texel_of_block(block, static_cast<int>(i)), &meant = texels[i];
        REQUIRE((shown.alpha == 0) == (meant.alpha == 0));
        if (meant.alpha == 0) continue;
        for (const int off : {shown.red - meant.red, shown.green - meant.green, shown.blue - meant.blue})
            sum += off * off;
    }
    return sum;
}

double psnr_db(double squares, double values) { return 10.0 * std::log10(255.0 * 255.0 * values / squares); }

}  // namespace

TEST_CASE(
    "blocks of every kind come as near as stb_dxt's high quality does, on average, and keep their holes") {
    for (int k = 0; k < kBlockKinds; ++k) {
        CAPTURE(k);
        std::mt19937 random(static_cast<unsigned>(k));
        double ours = 0.0, stb = 0.0, far_off = 0.0;
        constexpr int kBlocks = 4000;
        for (int i = 0; i < kBlocks; ++i) {
            const TexelBlock texels = random_block(static_cast<BlockKind>(k), random);
            const double error = squared_error(texels, encoded(texels));
            const double of_stb = squared_error(texels, encoded_by_stb(texels));
            ours += error;
            stb += of_stb;
            if (error > 2.0 * of_stb + 200.0) far_off += 1.0;
        }
        CHECK(far_off <= kBlocks / 100);
        if (stb > 0.0) CHECK(psnr_db(ours, kBlocks * 48.0) > psnr_db(stb, kBlocks * 48.0) - 0.4);
    }
}

TEST_CASE("a block of one colour is as near as any two endpoints come to it, in either mode") {
    std::mt19937 random(9);
    // Of a channel, over all pairs: what each mode can show.
    const auto best = [](int value, int bits) {
        std::array<double, 2> least = {1e9, 1e9};
        const int last = (1 << bits) - 1;
        for (int a = 0; a <= last; ++a)
            for (int b = 0; b <= last; ++b) {
                const double high = shaders::bc1_widened(a, bits), low = shaders::bc1_widened(b, bits);
                const auto off = [&](double shown) { return (shown - value) * (shown - value); };
                least[0] = std::min({least[0], off(high), off((2.0 * high + low) / 3.0)});
                least[1] = std::min({least[1], off(high), off((high + low) / 2.0)});
            }
        return least;
    };
    for (int i = 0; i < 300; ++i) {
        const TexelBlock texels = random_block(BlockKind::one_colour, random);
        const auto red = best(texels[0].red, 5), green = best(texels[0].green, 6),
                   blue = best(texels[0].blue, 5);
        const double least = std::min(red[0] + green[0] + blue[0], red[1] + green[1] + blue[1]);
        // The table of hardware rounds down: a little beside the exact mix.
        CHECK(squared_error(texels, encoded(texels)) / 16.0 <= least + 3.0);
    }
}

TEST_CASE("the same texels give the same block, and a block without holes says that it has none") {
    std::mt19937 random(10);
    for (int i = 0; i < 20000; ++i) {
        const TexelBlock texels = random_block(static_cast<BlockKind>(i % kBlockKinds), random);
        const io::Bc1Block block = encoded(texels), again = encoded(texels);
        REQUIRE(std::memcmp(&block, &again, sizeof block) == 0);
        const bool holes = std::ranges::any_of(texels, [](const build::Texel& t) { return t.alpha == 0; });
        REQUIRE(io::has_holes(block) == holes);
    }
}
