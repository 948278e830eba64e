// The shader that encodes blocks, compiled as C++: against what the format can at best, what is trivial, and
// stb_dxt.
#include "ridgeline/shaders/lib/bc1.h"

#include <doctest/doctest.h>
#include <gdal_priv.h>

#include <array>
#include <string>

#include "support/block_pictures.h"
#include "support/data.h"

using namespace ridgeline;
using namespace ridgeline::test;
using build::BlockTexels;
using build::Texel;

namespace {

io::Bc1Block encoded(const BlockTexels& texels) {
    const auto words = shaders::bc1_encoded(shader_texels(texels));
    return {static_cast<std::uint16_t>(words.x & 0xffffu), static_cast<std::uint16_t>(words.x >> 16),
            words.y};
}

using Channels = std::array<double, 3>;
Channels channels_of(const Texel& texel) { return {1.0 * texel.red, 1.0 * texel.green, 1.0 * texel.blue}; }

// As the format's text says, not rounded, straight from the bits.
Channels exact_colour(const io::Bc1Block& block, int texel) {
    const auto widened = [](std::uint16_t c) { return channels_of(texel_of_block({c, c, 0}, 0)); };
    const Channels first = widened(block.first), second = widened(block.second);
    const std::uint32_t index = block.indices >> (2 * texel) & 3u;
    const bool three = block.first <= block.second;
    const double share = index == 0 ? 1.0 : index == 1 ? 0.0 : three ? 0.5 : index == 2 ? 2.0 / 3 : 1.0 / 3;
    Channels mixed;
    for (std::size_t c = 0; c < 3; ++c) mixed[c] = share * first[c] + (1.0 - share) * second[c];
    return mixed;
}

double exact_error(const BlockTexels& texels, const io::Bc1Block& block) {
    double squares = 0.0;
    for (std::size_t i = 0; i < texels.size(); ++i) {
        if (texels[i].alpha == 0) continue;
        const Channels is = channels_of(texels[i]), shown = exact_colour(block, static_cast<int>(i));
        for (std::size_t c = 0; c < 3; ++c) squares += (is[c] - shown[c]) * (is[c] - shown[c]);
    }
    return squares;
}

// The least square by which a channel's value is missed where every texel takes so much of the second endpoint, by
// trying all endpoints.
double least_channel_error(int value, int bits, double share) {
    const auto widen = [bits](int q) { return q << (8 - bits) | q >> (2 * bits - 8); };
    double least = 1e9;
    for (int a = 0; a < 1 << bits; ++a)
        for (int b = 0; b < 1 << bits; ++b) {
            const double off = (1.0 - share) * widen(a) + share * widen(b) - value;
            least = std::min(least, off * off);
        }
    return least;
}

std::array<double, 256> least_channel_errors(int bits, double share) {
    std::array<double, 256> errors;
    for (int value = 0; value < 256; ++value)
        errors[static_cast<std::size_t>(value)] = least_channel_error(value, bits, share);
    return errors;
}

// Of both modes, for a block of one colour.
class LeastErrors {
  public:
    double of(const Texel& t, bool holes) const {
        const double three = halves5_[t.red] + halves6_[t.green] + halves5_[t.blue];
        const double four = thirds5_[t.red] + thirds6_[t.green] + thirds5_[t.blue];
        return holes ? three : std::min(three, four);
    }

  private:
    std::array<double, 256> thirds5_ = least_channel_errors(5, 1.0 / 3),
                            thirds6_ = least_channel_errors(6, 1.0 / 3),
                            halves5_ = least_channel_errors(5, 0.5), halves6_ = least_channel_errors(6, 0.5);
};

double psnr_db(double squares, double values) { return 10.0 * std::log10(255.0 * 255.0 * values / squares); }

// Quality of the shader's blocks and of stb_dxt's, as the hardware shows both.
struct Quality {
    double ours = 0.0, stb = 0.0, values = 0.0;

    void add(const BlockTexels& texels) {
        ours += squared_error(texels, encoded(texels));
        stb += squared_error(texels, build::encode_on_cpu(texels));
        for (const Texel& texel : texels) values += texel.alpha != 0 ? 3.0 : 0.0;
    }
    double ours_db() const { return psnr_db(ours, values); }
    double stb_db() const { return psnr_db(stb, values); }
};

}  // namespace

TEST_CASE("BC1: a block of one colour is as near to it as the format can come, with holes and without") {
    const LeastErrors least;
    RandomBlocks random(1);
    for (int i = 0; i < 3000; ++i) {
        const auto grey = static_cast<std::uint8_t>(i);
        const Texel colour = i < 256 ? Texel{grey, grey, grey, build::kOpaque} : random.any_texel();
        BlockTexels texels;
        texels.fill(colour);
        CAPTURE(i);
        CHECK(exact_error(texels, encoded(texels)) ==
              doctest::Approx(16.0 * least.of(colour, false)).epsilon(1e-9));
        for (std::size_t hole = 0; hole < 16; hole += 3) texels[hole].alpha = 0;
        CHECK(exact_error(texels, encoded(texels)) ==
              doctest::Approx(10.0 * least.of(colour, true)).epsilon(1e-9));
    }
}

TEST_CASE("BC1: what is transparent stays so, and nothing else becomes so") {
    RandomBlocks random(2);
    int wrong = 0;
    for (int i = 0; i < 20000; ++i) {
        BlockTexels texels = random.next(kBlockKinds[i % 5]);
        random.pierce(texels);
        const io::Bc1Block block = encoded(texels);
        for (std::size_t t = 0; t < 16; ++t)
            wrong += (texel_of_block(block, static_cast<int>(t)).alpha != 0) != (texels[t].alpha != 0);
        // Colours under holes mean nothing.
        BlockTexels blackened = texels;
        for (Texel& texel : blackened)
            if (texel.alpha == 0) texel = {};
        wrong += encoded(blackened) != block;
    }
    CHECK(wrong == 0);
}

TEST_CASE("BC1: no error above that of the mean colour, nor of the corners of the colours' box") {
    RandomBlocks random(3);
    int above_mean = 0, above_box = 0, holes = 0;
    const int rounds = 40000;
    for (int i = 0; i < rounds; ++i) {
        BlockTexels texels = random.next(kBlockKinds[i % 5]);
        if (i % 7 == 0) random.pierce(texels), ++holes;
        shaders::Bc1Colors colors = shaders::bc1_colors(shader_texels(texels));
        if (colors.count == 0) continue;
        const double error = exact_error(texels, encoded(texels));
        shaders::Bc1Fit fit;
        fit.steps = colors.count == 16 ? shaders::kBc1FourColors : shaders::kBc1ThreeColors;
        fit.high = fit.low = shaders::bc1_quantized(colors.sum / static_cast<float>(colors.count));
        shaders::bc1_weigh(colors, fit);
        const double steps = fit.steps * fit.steps;
        above_mean += error > fit.error / steps + 1e-6;
        fit.high = shaders::bc1_quantized(colors.most);
        fit.low = shaders::bc1_quantized(colors.least);
        shaders::bc1_weigh(colors, fit);
        above_box += error > fit.error / steps + 1e-6;
    }
    MESSAGE(rounds, " blocks, ", holes, " with holes: ", above_box, " above the box's corners");
    CHECK(above_mean == 0);
    CHECK(above_box == 0);
}

TEST_CASE("BC1: the error that a fit says is that of its texels, and no other weights make it less") {
    RandomBlocks random(4);
    for (int i = 0; i < 4000; ++i) {
        BlockTexels texels = random.next(kBlockKinds[i % 5]);
        const bool whole = i % 3 != 0;
        if (!whole) random.pierce(texels);
        const shaders::Bc1Colors colors = shaders::bc1_colors(shader_texels(texels));
        if (colors.count == 0) continue;
        shaders::Bc1Fit fit;
        fit.steps = colors.count == 16 ? shaders::kBc1FourColors : shaders::kBc1ThreeColors;
        const Texel a = random.any_texel(), b = random.any_texel();
        fit.high = shaders::ivec3(a.red >> 3, a.green >> 2, a.blue >> 3);
        fit.low = shaders::ivec3(b.red >> 3, b.green >> 2, b.blue >> 3);
        shaders::bc1_weigh(colors, fit);
        const auto words = shaders::bc1_block(colors, fit);
        const io::Bc1Block block{static_cast<std::uint16_t>(words.x & 0xffffu),
                                 static_cast<std::uint16_t>(words.x >> 16), words.y};
        const double error = exact_error(texels, block);
        CHECK(error == doctest::Approx(1.0 * fit.error / (fit.steps * fit.steps)).epsilon(1e-9));
        for (int t = 0; t < 16; ++t)
            for (std::uint32_t index = 0; index < (block.first <= block.second ? 3u : 4u); ++index) {
                if (texels[static_cast<std::size_t>(t)].alpha == 0) continue;
                io::Bc1Block other = block;
                other.indices = (block.indices & ~(3u << (2 * t))) | index << (2 * t);
                CHECK(exact_error(texels, other) >= error - 1e-6);
            }
    }
}

TEST_CASE("BC1: within 0.3 dB of stb_dxt's high quality on noise, gradients, edges and faint colours") {
    for (const BlockKind kind : kBlockKinds)
        for (const bool holes : {false, true}) {
            RandomBlocks random(5);
            Quality quality;
            for (int i = 0; i < 20000; ++i) {
                BlockTexels texels = random.next(kind);
                if (holes) random.pierce(texels);
                quality.add(texels);
            }
            MESSAGE("kind ", static_cast<int>(kind), holes ? " with holes: " : ": ", quality.ours_db(),
                    " dB, stb_dxt ", quality.stb_db());
            CHECK(quality.ours_db() > quality.stb_db() - 0.3);
        }
}

TEST_CASE("BC1: within 0.3 dB of stb_dxt's high quality on pictures from above") {
    GDALAllRegister();
    for (const char* name :
         {"zion/landsat_rgb_8bit_utm12n_30m.tif", "crater_lake/craterlake-imagery-30m.tif"}) {
        const auto file = data_file(name);
        if (file.empty()) return;
        const GDALDatasetUniquePtr dataset(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER));
        REQUIRE(dataset);
        const int width = dataset->GetRasterXSize(), height = dataset->GetRasterYSize();
        const auto stride = static_cast<std::size_t>(width);
        std::vector<Texel> texels(stride * static_cast<std::size_t>(height), Texel{0, 0, 0, build::kOpaque});
        int bands[] = {1, 2, 3};
        REQUIRE(dataset->RasterIO(GF_Read, 0, 0, width, height, texels.data(), width, height, GDT_Byte, 3,
                                  bands, 4, GSpacing{4} * width, 1, nullptr) == CE_None);
        Quality quality;
        BlockTexels block;
        for (std::size_t y = 0; y + 4 <= static_cast<std::size_t>(height); y += 4)
            for (std::size_t x = 0; x + 4 <= stride; x += 4) {
                for (std::size_t i = 0; i < 16; ++i) block[i] = texels[(y + i / 4) * stride + x + i % 4];
                quality.add(block);
            }
        MESSAGE(name, ": ", quality.ours_db(), " dB, stb_dxt ", quality.stb_db());
        CHECK(quality.ours_db() > quality.stb_db() - 0.3);
    }
}
