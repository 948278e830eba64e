// Imagery encoded on the GPU: what its shader gives is what the same text gives on the CPU, whoever asks and
// however many at once.
#include "ridgeline/gpu_encoder/gpu_encoder.h"

#include <doctest/doctest.h>

#include <bit>
#include <cstring>
#include <thread>

#include "ridgeline/build/imagery/imagery_layer.h"
#include "ridgeline/shaders/lib/bc1.h"
#include "support/gl_context.h"
#include "support/small_imagery.h"
#include "support/small_store.h"
#include "support/texel_blocks.h"

using namespace ridgeline;
using namespace ridgeline::test;

namespace {

// A square of blocks of every kind.
std::vector<build::Texel> random_square(int side, unsigned seed) {
    std::mt19937 random(seed);
    const auto stride = static_cast<std::size_t>(side);
    std::vector<build::Texel> texels(stride * stride);
    for (std::size_t y = 0; y < stride; y += 4)
        for (std::size_t x = 0; x < stride; x += 4) {
            const TexelBlock block = random_block(static_cast<BlockKind>(random() % kBlockKinds), random);
            for (std::size_t i = 0; i < block.size(); ++i)
                texels[(y + i / 4) * stride + x + i % 4] = block[i];
        }
    return texels;
}

std::vector<io::Bc1Block> encoded_on_cpu(const std::vector<build::Texel>& texels, int side) {
    const auto stride = static_cast<std::size_t>(side);
    std::vector<io::Bc1Block> blocks;
    for (std::size_t y = 0; y < stride; y += 4)
        for (std::size_t x = 0; x < stride; x += 4) {
            shaders::Bc1Texels packed;
            for (std::size_t row = 0; row < 4; ++row)
                std::memcpy(&packed.rows[row], &texels[(y + row) * stride + x], 16);
            blocks.push_back(std::bit_cast<io::Bc1Block>(shaders::bc1_encoded(packed)));
        }
    return blocks;
}

std::size_t differing(const std::vector<io::Bc1Block>& a, const std::vector<io::Bc1Block>& b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.size(); ++i) count += std::memcmp(&a[i], &b[i], sizeof a[i]) != 0 ? 1 : 0;
    return count;
}

}  // namespace

TEST_CASE("the GPU's blocks are those of the same functions on the CPU") {
    // Skips where there is no GL.
    GlContext gl;
    if (!gl) return;
    auto encoder = build::GpuEncoder::create();
    REQUIRE_MESSAGE(encoder.ok(), (encoder.ok() ? "" : encoder.error().message));
    for (const int side : {4, 8, 132, 264}) {
        CAPTURE(side);
        const auto texels = random_square(side, static_cast<unsigned>(side));
        const auto expected = encoded_on_cpu(texels, side);
        std::vector<io::Bc1Block> blocks(expected.size());
        REQUIRE((*encoder)->encode(texels, side, blocks));
        CHECK(differing(blocks, expected) == 0);
    }
}

TEST_CASE("many threads at once each get their own blocks") {
    GlContext gl;
    if (!gl) return;
    auto encoder = build::GpuEncoder::create();
    REQUIRE(encoder.ok());
    std::vector<std::size_t> wrong(8, 0);
    std::vector<std::thread> threads;
    for (unsigned t = 0; t < wrong.size(); ++t)
        threads.emplace_back([&, t] {
            for (unsigned i = 0; i < 6; ++i) {
                const int side = i % 2 == 0 ? 264 : 132;
                const auto texels = random_square(side, 100 * t + i);
                const auto expected = encoded_on_cpu(texels, side);
                std::vector<io::Bc1Block> blocks(expected.size());
                const bool encoded = (*encoder)->encode(texels, side, blocks).ok();
                wrong[t] += encoded ? differing(blocks, expected) : blocks.size();
            }
        });
    for (std::thread& thread : threads) thread.join();
    for (const std::size_t count : wrong) CHECK(count == 0);
}

namespace {

class Failing : public build::ImageEncoder {
  public:
    Result<void> encode(std::span<const build::Texel>, int, std::span<io::Bc1Block>) override {
        return Error{"the GPU does not answer"};
    }
};

class Large final : public Failing {
  public:
    std::uint64_t memory_bytes() const override { return 500_MiB; }
};

// Of a small picture over a small store.
std::string error_of_layer(build::ImageEncoder& encoder, std::uint64_t memory_bytes) {
    const ReferenceTerrain terrain(io::Grid(65, 65, 32), [](std::int64_t, std::int64_t) { return 7; });
    const SmallStore store(terrain);
    const auto info = io::read_terrain_info(store.directory());
    REQUIRE(info);
    MemoryTexels texels(frame_over(*info, 4), [](std::int64_t, std::int64_t) {
        return build::Texel{1, 2, 3, build::kOpaque};
    });
    auto update = io::StoreUpdate::begin(store.directory(), io::Replace::existing);
    REQUIRE(update);
    build::LayerOptions options;
    options.encoder = &encoder;
    options.memory_bytes = memory_bytes;
    const auto built = build::build_imagery_layer(texels, update->directory(), update->scratch(), options);
    REQUIRE_FALSE(built);
    return built.error().message;
}

}  // namespace

TEST_CASE("an encoder that fails ends the layer with its error") {
    Failing failing;
    CHECK(error_of_layer(failing, 1_GiB).find("does not answer") != std::string::npos);
}

TEST_CASE("what an encoder takes for itself counts in --memory") {
    Failing small;
    Large large;
    CHECK(error_of_layer(small, 500_MiB).find("does not answer") != std::string::npos);
    const std::string refused = error_of_layer(large, 500_MiB);
    CAPTURE(refused);
    REQUIRE(refused.find("use --memory ") != std::string::npos);
    const auto least = std::stoull(refused.substr(refused.find("use --memory ") + 13));
    CHECK(error_of_layer(large, least << 20).find("does not answer") != std::string::npos);
}
