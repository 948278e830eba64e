// Imagery: the encoder beside others in rate and PSNR on the same texels, the way from decoded texels to a
// layer, and what a store's imagery takes and how near it comes to its source.
//
//   bench_imagery encoders RASTER.tif [ROWS]     a CPU second on one thread; the first ROWS rows (1024)
//   bench_imagery layer RASTER.tif [JOBS]        from texels in memory to imagery.bin and imagery.tiles
//   bench_imagery store DIR.terrain RASTER.tif   bytes a source pixel, PSNR of the finest level; a raster that the
//                                                store's lattice begins with
//   bench_imagery picture DIR.terrain LEVEL OUT.png
//
// RASTER: three bands of bytes.
#include <gdal_priv.h>
#include <squish.h>
#include <sys/resource.h>
#include <unistd.h>

#include <bit>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "ridgeline/build/imagery/imagery_builder.h"
#include "ridgeline/io/imagery_writer.h"
#include "ridgeline/io/store.h"
#include "ridgeline/shaders/lib/bc1.h"
#include "support/bc1.h"

#define STB_DXT_STATIC
#define STB_DXT_IMPLEMENTATION
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_dxt.h>
#pragma GCC diagnostic pop

using namespace ridgeline;
using build::Texel;
namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const std::string& why) {
    std::fprintf(stderr, "bench_imagery: %s\n", why.c_str());
    std::exit(1);
}

template <class T>
T expect(Result<T> result) {
    if (!result) fail(result.error().message);
    return std::move(*result);
}
void expect(const Result<void>& result) {
    if (!result) fail(result.error().message);
}

double seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}
// Of the calling thread alone, so that what else runs on the machine counts little.
double thread_seconds() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}
double cpu_seconds() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto of = [](const timeval& t) {
        return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    return of(usage.ru_utime) + of(usage.ru_stime);
}

struct Picture {
    std::int64_t width = 0, height = 0;
    std::vector<Texel> texels;

    const Texel& at(std::int64_t x, std::int64_t y) const {
        return texels[static_cast<std::size_t>(y * width + x)];
    }
};

Picture read_picture(const std::string& path, std::int64_t most_rows) {
    const GDALDatasetUniquePtr dataset(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER));
    if (!dataset || dataset->GetRasterCount() < 3) fail(path + ": not a raster of three bands");
    Picture picture;
    picture.width = dataset->GetRasterXSize();
    picture.height = std::min<std::int64_t>(dataset->GetRasterYSize(), most_rows);
    picture.texels.assign(static_cast<std::size_t>(picture.width * picture.height),
                          {0, 0, 0, build::kOpaque});
    const int width = static_cast<int>(picture.width), height = static_cast<int>(picture.height);
    int bands[] = {1, 2, 3};
    if (dataset->RasterIO(GF_Read, 0, 0, width, height, picture.texels.data(), width, height, GDT_Byte, 3,
                          bands, 4, GSpacing{4} * width, 1, nullptr) != CE_None)
        fail(path + ": cannot be read");
    return picture;
}

double psnr_db(double squares, double values) { return 10.0 * std::log10(255.0 * 255.0 * values / squares); }

double squares_between(const Texel& a, const Texel& b) {
    const double red = a.red - b.red, green = a.green - b.green, blue = a.blue - b.blue;
    return red * red + green * green + blue * blue;
}

// --- encoders ----------------------------------------------------------------------------------------------

using EncodeBlock = std::function<io::Bc1Block(const Texel* sixteen)>;

void compare_encoder(const char* name, const Picture& picture, std::int64_t every,
                     const EncodeBlock& encode) {
    double squares = 0.0, taken = 0.0;
    std::int64_t blocks = 0;
    std::vector<Texel> sixteen(16);
    std::vector<Texel> row_blocks;
    std::vector<io::Bc1Block> out;
    for (std::int64_t y = 0; y + 4 <= picture.height; y += 4 * every) {
        row_blocks.clear();
        for (std::int64_t x = 0; x + 4 <= picture.width; x += 4)
            for (std::int64_t t = 0; t < 16; ++t) row_blocks.push_back(picture.at(x + t % 4, y + t / 4));
        const std::size_t count = row_blocks.size() / 16;
        out.resize(count);
        const double start = thread_seconds();
        for (std::size_t i = 0; i < count; ++i) out[i] = encode(&row_blocks[i * 16]);
        taken += thread_seconds() - start;
        for (std::size_t i = 0; i < count * 16; ++i)
            squares +=
                squares_between(row_blocks[i], test::texel_of_block(out[i / 16], static_cast<int>(i % 16)));
        blocks += static_cast<std::int64_t>(count);
    }
    const double texels = 16.0 * static_cast<double>(blocks);
    std::printf("%-32s %8.2f Mpixel/s %7.2f dB\n", name, texels / taken / 1e6,
                psnr_db(squares, 3.0 * texels));
}

io::Bc1Block stb(const Texel* texels, int mode) {
    io::Bc1Block block;
    stb_compress_dxt_block(reinterpret_cast<unsigned char*>(&block),
                           reinterpret_cast<const unsigned char*>(texels), 0, mode);
    return block;
}
io::Bc1Block squish_block(const Texel* texels, int flags) {
    io::Bc1Block block;
    float uniform[] = {1.0f, 1.0f, 1.0f};
    squish::CompressMasked(reinterpret_cast<const squish::u8*>(texels), 0xffff, &block, squish::kDxt1 | flags,
                           uniform);
    return block;
}

void compare_encoders(const Picture& picture) {
    // The slow ones see every 16th row of blocks, and so do lines of ours beside them.
    constexpr std::int64_t kFew = 16;
    const auto encoder = build::make_cpu_encoder();
    const EncodeBlock ours = [&](const Texel* texels) {
        io::Bc1Block block;
        encoder->encode(std::span(texels, 16), 4, std::span(&block, 1));
        return block;
    };
    const EncodeBlock shader = [](const Texel* texels) {
        shaders::Bc1Texels packed;
        std::memcpy(&packed, texels, sizeof packed);
        return std::bit_cast<io::Bc1Block>(shaders::bc1_encoded(packed));
    };
    compare_encoder("ours", picture, 1, ours);
    compare_encoder("ours of GPUs, as C++", picture, 1, shader);
    compare_encoder("stb_dxt, high quality", picture, 1, [](auto* t) { return stb(t, STB_DXT_HIGHQUAL); });
    compare_encoder("stb_dxt, normal", picture, 1, [](auto* t) { return stb(t, STB_DXT_NORMAL); });
    compare_encoder("squish, range fit", picture, 1,
                    [](auto* t) { return squish_block(t, squish::kColourRangeFit); });
    compare_encoder("ours, every 16th row", picture, kFew, ours);
    compare_encoder("ours of GPUs, every 16th row", picture, kFew, shader);
    compare_encoder("squish, cluster fit", picture, kFew,
                    [](auto* t) { return squish_block(t, squish::kColourClusterFit); });
    compare_encoder("squish, iterative cluster fit", picture, kFew,
                    [](auto* t) { return squish_block(t, squish::kColourIterativeClusterFit); });
}

// --- layer -------------------------------------------------------------------------------------------------

class PictureRows final : public build::TexelRows {
  public:
    explicit PictureRows(const Picture& picture) : picture_(picture) {
        info_.width = picture.width;
        info_.height = picture.height;
    }
    const io::ImageryInfo& info() const override { return info_; }
    Result<void> read(std::int64_t row, std::int64_t rows, std::span<Texel> texels) override {
        std::memcpy(texels.data(), &picture_.at(0, row),
                    static_cast<std::size_t>(rows * info_.width) * sizeof(Texel));
        return {};
    }

  private:
    const Picture& picture_;
    io::ImageryInfo info_;
};

void build_layer(const Picture& picture, int threads) {
    const fs::path folder = fs::temp_directory_path() / ("bench-imagery-" + std::to_string(::getpid()));
    fs::create_directories(folder / "scratch");
    PictureRows rows(picture);
    io::ImageryInfo info = rows.info();
    const double texels = static_cast<double>(picture.width) * static_cast<double>(picture.height);
    {
        jobs::JobSystemOptions options;
        options.workers = std::max(1, threads - 1);
        jobs::JobSystem jobs(options);
        const auto encoder = build::make_cpu_encoder();
        auto writer = expect(io::ImageryWriter::create(folder, folder / "scratch", info.grid()));
        const double start = seconds(), cpu_start = cpu_seconds();
        expect(build::build_tiles({rows, *encoder, jobs, {}}, writer));
        const double tiles = seconds() - start;
        expect(writer.finish(info));
        const double all = seconds() - start, cpu = cpu_seconds() - cpu_start;
        std::printf(
            "%lld x %lld texels, %d threads: tiles %.2f s, with writing %.2f s, %.1f Mpixel/s; "
            "%.1f Mpixel/s a CPU second\n",
            static_cast<long long>(picture.width), static_cast<long long>(picture.height), threads, tiles,
            all, texels / all / 1e6, texels / cpu / 1e6);
    }
    std::printf("%.3f bytes a pixel, %lld tiles\n", static_cast<double>(info.bytes) / texels,
                static_cast<long long>(info.tiles));
    fs::remove_all(folder);
}

// --- store -------------------------------------------------------------------------------------------------

std::vector<io::Bc1Block> read_tile(const io::Store& store, io::NodeId node) {
    std::vector<std::uint8_t> bytes;
    expect(store.read_payload(io::Layer::imagery, node, bytes));
    std::vector<io::Bc1Block> blocks(io::kImageryBlockCount);
    io::ImageryScratch scratch;
    expect(io::decode_imagery(bytes, scratch, std::as_writable_bytes(std::span(blocks))));
    return blocks;
}

// Calls visit(x, y, texel) for every texel of a level that has a tile.
void for_each_texel(const io::Store& store, int level,
                    const std::function<void(std::int64_t, std::int64_t, const Texel&)>& visit) {
    const io::Grid& grid = store.imagery_grid();
    const std::int64_t width = (grid.width() - 2) / grid.step(level) + 1;
    const std::int64_t height = (grid.height() - 2) / grid.step(level) + 1;
    for (std::int64_t i = grid.first(level); i < grid.first(level + 1); ++i) {
        const io::NodeId node = grid.node_at(i);
        if (!store.imagery_record(node).has_data()) continue;
        const auto blocks = read_tile(store, node);
        const std::int64_t west = std::int64_t{node.x} * io::kImageryTile;
        const std::int64_t north = std::int64_t{node.y} * io::kImageryTile;
        for (int y = 0; y < std::min<std::int64_t>(io::kImageryTile, height - north); ++y)
            for (int x = 0; x < std::min<std::int64_t>(io::kImageryTile, width - west); ++x)
                visit(west + x, north + y, test::texel_of(blocks, x, y));
    }
}

void judge_store(const io::Store& store, const std::string& raster) {
    const io::ImageryInfo& info = *store.info().imagery;
    const Picture picture = read_picture(raster, info.height);
    double squares = 0.0, texels = 0.0;
    for_each_texel(store, store.imagery_grid().finest(),
                   [&](std::int64_t x, std::int64_t y, const Texel& texel) {
                       if (x >= picture.width || y >= picture.height || texel.alpha == 0) return;
                       squares += squares_between(texel, picture.at(x, y));
                       ++texels;
                   });
    std::printf("%.3f bytes a source pixel, %.2f dB over %.0f texels\n",
                static_cast<double>(info.bytes) /
                    (static_cast<double>(info.width) * static_cast<double>(info.height)),
                psnr_db(squares, 3.0 * texels), texels);
}

void draw(const io::Store& store, int level, const std::string& png) {
    const io::Grid& grid = store.imagery_grid();
    const int width = static_cast<int>((grid.width() - 2) / grid.step(level) + 1);
    const int height = static_cast<int>((grid.height() - 2) / grid.step(level) + 1);
    std::vector<Texel> texels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    for_each_texel(store, level, [&](std::int64_t x, std::int64_t y, const Texel& texel) {
        texels[static_cast<std::size_t>(y * width + x)] = texel;
    });
    GDALDriver* memory = GetGDALDriverManager()->GetDriverByName("MEM");
    GDALDriver* writer = GetGDALDriverManager()->GetDriverByName("PNG");
    const GDALDatasetUniquePtr image(memory->Create("", width, height, 4, GDT_Byte, nullptr));
    int bands[] = {1, 2, 3, 4};
    if (image->RasterIO(GF_Write, 0, 0, width, height, texels.data(), width, height, GDT_Byte, 4, bands, 4,
                        GSpacing{4} * width, 1, nullptr) != CE_None)
        fail("out of memory");
    const GDALDatasetUniquePtr written(
        writer->CreateCopy(png.c_str(), image.get(), FALSE, nullptr, nullptr, nullptr));
    if (!written) fail(png + ": cannot be written");
}

io::Store open_store(const std::string& path) {
    io::Store store = expect(io::Store::open(path));
    if (!store.info().imagery) fail(path + ": has no imagery");
    return store;
}

}  // namespace

int main(int count, char** words) {
    GDALAllRegister();
    const std::string what = count > 2 ? words[1] : "";
    constexpr std::int64_t kAllRows = INT32_MAX;
    if (what == "encoders")
        compare_encoders(read_picture(words[2], count > 3 ? std::atoi(words[3]) : 1024));
    else if (what == "layer")
        build_layer(read_picture(words[2], kAllRows), count > 3 ? std::atoi(words[3]) : 2);
    else if (what == "store" && count == 4)
        judge_store(open_store(words[2]), words[3]);
    else if (what == "picture" && count == 5)
        draw(open_store(words[2]), std::atoi(words[3]), words[4]);
    else
        fail(
            "use encoders RASTER, layer RASTER, store DIR.terrain RASTER or picture DIR.terrain LEVEL "
            "OUT.png");
    return 0;
}
