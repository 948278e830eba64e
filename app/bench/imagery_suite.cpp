#include "ridgeline/app/bench/imagery_suite.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <system_error>

#include "ridgeline/build/imagery/block_texels.h"
#include "ridgeline/build/imagery/image_rows.h"
#include "ridgeline/build/imagery/imagery_layer.h"
#include "ridgeline/io/store.h"

namespace ridgeline::app {
namespace {

using build::Texel;
namespace fs = std::filesystem;

const std::string kVariants = "imagery/";

double seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// The source, decoded; of a large one as many of its northmost rows as are allowed.
class DecodedRows final : public build::TexelRows {
  public:
    static Result<DecodedRows> decode(build::TexelRows& source, std::int64_t most_texels) {
        DecodedRows decoded;
        decoded.info_ = source.info();
        decoded.info_.height =
            std::clamp(most_texels / decoded.info_.width, std::int64_t{1}, decoded.info_.height);
        const auto width = static_cast<std::size_t>(decoded.info_.width);
        decoded.texels_.resize(width * static_cast<std::size_t>(decoded.info_.height));
        constexpr std::int64_t kBand = 256;
        for (std::int64_t row = 0; row < decoded.info_.height; row += kBand) {
            const std::int64_t rows = std::min(kBand, decoded.info_.height - row);
            const auto band =
                std::span(decoded.texels_)
                    .subspan(static_cast<std::size_t>(row) * width, static_cast<std::size_t>(rows) * width);
            RIDGELINE_TRY(source.read(row, rows, band));
        }
        return decoded;
    }

    const io::ImageryInfo& info() const override { return info_; }
    Result<void> read(std::int64_t row, std::int64_t rows, std::span<Texel> texels) override {
        std::memcpy(texels.data(), &at(0, row), static_cast<std::size_t>(rows * info_.width) * sizeof(Texel));
        return {};
    }

    double count() const { return static_cast<double>(texels_.size()); }
    const Texel& at(std::int64_t x, std::int64_t y) const {
        return texels_[static_cast<std::size_t>(y * info_.width + x)];
    }

  private:
    io::ImageryInfo info_;
    std::vector<Texel> texels_;
};

// Squares of the picture, one after another; past its border its last texels repeat.
constexpr int kSquare = 256;

void cut(const DecodedRows& picture, std::int64_t west, std::int64_t north, std::span<Texel> square) {
    for (std::int64_t y = 0; y < kSquare; ++y)
        for (std::int64_t x = 0; x < kSquare; ++x)
            square[static_cast<std::size_t>(y * kSquare + x)] = picture.at(
                std::min(west + x, picture.info().width - 1), std::min(north + y, picture.info().height - 1));
}

// Over the square's opaque texels that the picture has.
struct Misses {
    double squares = 0.0;
    double values = 0.0;

    void add(const Texel& meant, const Texel& shown) {
        for (const int off : {meant.red - shown.red, meant.green - shown.green, meant.blue - shown.blue})
            squares += off * off;
        values += 3.0;
    }
    double psnr_db() const { return 10.0 * std::log10(255.0 * 255.0 * values / squares); }
};

void judge(std::span<const Texel> square, std::span<const io::Bc1Block> blocks, const glm::ivec2& size,
           Misses& misses) {
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            const Texel& meant = square[static_cast<std::size_t>(y * kSquare + x)];
            if (meant.alpha == 0) continue;
            const io::Bc1Block& block = blocks[static_cast<std::size_t>(y / 4 * (kSquare / 4) + x / 4)];
            misses.add(meant, build::texel_of_block(block, y % 4 * 4 + x % 4));
        }
}

Result<void> measure_blocks(const DecodedRows& picture, build::ImageEncoder& encoder,
                            const std::string& variant, Figures& figures) {
    std::vector<Texel> square(std::size_t{kSquare} * kSquare);
    std::vector<io::Bc1Block> blocks(square.size() / 16);
    Misses misses;
    double taken = 0.0, encoded = 0.0;
    for (std::int64_t y = 0; y < picture.info().height; y += kSquare)
        for (std::int64_t x = 0; x < picture.info().width; x += kSquare) {
            cut(picture, x, y, square);
            const double start = seconds();
            RIDGELINE_TRY(encoder.encode(square, kSquare, blocks));
            taken += seconds() - start;
            encoded += static_cast<double>(square.size());
            judge(square, blocks,
                  {std::min<std::int64_t>(kSquare, picture.info().width - x),
                   std::min<std::int64_t>(kSquare, picture.info().height - y)},
                  misses);
        }
    figures.set(variant, "encode_mpixel_per_s", encoded / taken / 1e6);
    // Without an error there is no ratio to state.
    if (misses.squares > 0.0) figures.set(variant, "psnr_db", misses.psnr_db());
    return {};
}

Result<void> measure_layer(DecodedRows& picture, build::ImageEncoder& encoder, const std::string& variant,
                           const ImagerySuiteOptions& options, Figures& figures) {
    const fs::path folder = options.scratch / "imagery-layer";
    std::error_code failed;
    fs::remove_all(folder, failed);
    if (!fs::create_directories(folder / "scratch", failed))
        return Error{folder.string() + ": cannot make the folder: " + failed.message()};
    build::LayerOptions layer;
    layer.threads = options.threads;
    layer.encoder = &encoder;
    const double start = seconds();
    const auto info = build::build_imagery_layer(picture, folder, folder / "scratch", layer);
    const double taken = seconds() - start;
    fs::remove_all(folder, failed);
    if (!info) return info.error();
    figures.set(variant, "mpixel_per_s", picture.count() / taken / 1e6);
    figures.set(variant, "layer_bytes", static_cast<double>(info->bytes));
    figures.set(variant, "bytes_per_pixel", static_cast<double>(info->bytes) / picture.count());
    return {};
}

// 0 where one of them is no file.
std::uintmax_t bytes_of(const std::vector<std::string>& sources) {
    std::uintmax_t sum = 0;
    for (const std::string& source : sources) {
        std::error_code failed;
        const std::uintmax_t bytes = fs::file_size(source, failed);
        if (failed) return 0;
        sum += bytes;
    }
    return sum;
}

}  // namespace

Result<Figures> compare_encoders(build::TexelRows& source, const std::vector<NamedEncoder>& encoders,
                                 const ImagerySuiteOptions& options) {
    auto picture = DecodedRows::decode(source, options.most_texels);
    if (!picture) return picture.error();
    const auto steps = static_cast<std::int64_t>(2 * encoders.size());
    std::int64_t done = 0;
    const auto report = [&] {
        if (options.progress) options.progress(++done, steps);
    };
    Figures figures;
    for (const NamedEncoder& named : encoders) {
        const std::string variant = kVariants + named.name;
        RIDGELINE_TRY(measure_layer(*picture, *named.encoder, variant, options, figures));
        report();
        RIDGELINE_TRY(measure_blocks(*picture, *named.encoder, variant, figures));
        report();
    }
    return figures;
}

Result<Figures> run_imagery_suite(const ImagerySuiteSource& source, const std::vector<NamedEncoder>& encoders,
                                  const ImagerySuiteOptions& options) {
    const auto store = io::Store::open(source.store);
    if (!store) return store.error();
    std::vector<std::string> rasters = source.rasters;
    if (rasters.empty() && store->info().imagery) rasters = store->info().imagery->sources;
    if (rasters.empty()) return Error{source.store.string() + ": has no imagery: name a raster by --source"};
    auto rows = build::open_imagery({.paths = rasters, .threads = options.threads}, store->info());
    if (!rows)
        return source.rasters.empty()
                   ? Error{rows.error().message + ": as the store names it; name the raster by --source"}
                   : rows.error();
    auto figures = compare_encoders(**rows, encoders, options);
    if (!figures) return figures.error();
    const io::ImageryInfo& info = (*rows)->info();
    const std::uintmax_t bytes = bytes_of(rasters);
    if (bytes > 0 && info.width * info.height <= options.most_texels)
        for (const NamedEncoder& named : encoders)
            figures->set(kVariants + named.name, "source_bytes", static_cast<double>(bytes));
    return figures;
}

}  // namespace ridgeline::app
