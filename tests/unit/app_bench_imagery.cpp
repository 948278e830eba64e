// Suite `imagery`: what it says of an encoder, held against the picture itself.
#include <doctest/doctest.h>

#include <cmath>

#include "ridgeline/app/bench/imagery_suite.h"
#include "support/small_imagery.h"
#include "unit/build_fixture.h"

using namespace ridgeline;
using namespace ridgeline::test;

namespace {

build::Texel colour(std::int64_t x, std::int64_t y) {
    const auto hole = (x / 30 + y / 40) % 5 == 2;
    return {static_cast<std::uint8_t>(x % 251), static_cast<std::uint8_t>(y % 241),
            static_cast<std::uint8_t>((x * y) % 200), hole ? std::uint8_t{0} : build::kOpaque};
}

MemoryTexels picture(std::int64_t width, std::int64_t height) {
    io::ImageryInfo frame;
    frame.width = width;
    frame.height = height;
    return MemoryTexels(frame, colour);
}

// Every block the same grey, of eight quanta in 31.
class Grey final : public build::ImageEncoder {
  public:
    Result<void> encode(std::span<const build::Texel>, int, std::span<io::Bc1Block> blocks) override {
        std::ranges::fill(blocks, io::Bc1Block{0x4208, 0x4208, 0});
        return {};
    }
};

}  // namespace

TEST_CASE("imagery suite: PSNR is that of the picture's own opaque texels, whatever its size") {
    const ScratchFolder folder;
    Grey grey;
    const auto stb = build::make_cpu_encoder();
    for (const auto& [width, height] : {std::pair{300, 260}, std::pair{17, 9}, std::pair{513, 256}}) {
        auto source = picture(width, height);
        app::ImagerySuiteOptions options;
        options.scratch = folder.path();
        const auto figures = app::compare_encoders(source, {{"grey", &grey}, {"cpu", stb.get()}}, options);
        REQUIRE_MESSAGE(figures.ok(), (figures.ok() ? "" : figures.error().message));
        double squares = 0.0, values = 0.0;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const build::Texel texel = colour(x, y);
                if (texel.alpha == 0) continue;
                // As the hardware widens 8 and 16 of 5 and 6 bits.
                for (const int off : {texel.red - 66, texel.green - 65, texel.blue - 66})
                    squares += off * off;
                values += 3.0;
            }
        CHECK(*figures->find("imagery/grey", "psnr_db") ==
              doctest::Approx(10.0 * std::log10(255.0 * 255.0 * values / squares)));
        CHECK(*figures->find("imagery/cpu", "psnr_db") > *figures->find("imagery/grey", "psnr_db") + 3.0);
        CHECK(*figures->find("imagery/cpu", "mpixel_per_s") > 0.0);
        CHECK(*figures->find("imagery/cpu", "bytes_per_pixel") ==
              doctest::Approx(*figures->find("imagery/cpu", "layer_bytes") / (width * height)));
        CHECK(folder.entries().empty());
    }
}

TEST_CASE("imagery suite: of a large picture the northmost rows are taken; a store without any is refused") {
    const ScratchFolder folder;
    const auto stb = build::make_cpu_encoder();
    app::ImagerySuiteOptions options;
    options.scratch = folder.path();
    options.most_texels = 300 * 64;
    auto large = picture(300, 4000), small = picture(300, 64);
    const auto of_large = app::compare_encoders(large, {{"cpu", stb.get()}}, options);
    const auto of_small = app::compare_encoders(small, {{"cpu", stb.get()}}, options);
    REQUIRE(of_large);
    REQUIRE(of_small);
    for (const char* metric : {"psnr_db", "layer_bytes"})
        CHECK(*of_large->find("imagery/cpu", metric) == *of_small->find("imagery/cpu", metric));

    const auto absent =
        app::run_imagery_suite({folder.path() / "absent.terrain", {}}, {{"cpu", stb.get()}}, options);
    CHECK_FALSE(absent);
}
