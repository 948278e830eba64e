// Pictures in memory as an imagery layer, by the builder's own way through them.
#pragma once

#include <doctest/doctest.h>

#include <fstream>
#include <functional>
#include <random>

#include "ridgeline/build/imagery/imagery_builder.h"
#include "ridgeline/io/imagery_writer.h"
#include "ridgeline/io/store.h"
#include "ridgeline/io/store_update.h"
#include "support/bc1.h"

namespace ridgeline::test {

class MemoryTexels final : public build::TexelRows {
  public:
    using Colour = std::function<build::Texel(std::int64_t x, std::int64_t y)>;

    // `frame` says where and how large; its tiles and bytes mean nothing.
    MemoryTexels(const io::ImageryInfo& frame, Colour colour) : info_(frame), colour_(std::move(colour)) {
        info_.sources = {"memory"};
        info_.generator = "test";
    }

    const io::ImageryInfo& info() const override { return info_; }
    Result<void> read(std::int64_t row, std::int64_t rows, std::span<build::Texel> texels) override {
        if (on_read) RIDGELINE_TRY(on_read(row));
        for (std::int64_t y = 0, i = 0; y < rows; ++y)
            for (std::int64_t x = 0; x < info_.width; ++x, ++i)
                texels[static_cast<std::size_t>(i)] = colour_(x, row + y);
        return {};
    }

    std::function<Result<void>(std::int64_t row)> on_read;

  private:
    io::ImageryInfo info_;
    Colour colour_;
};

// A frame of texels that covers a store's terrain, `ratio` of them between two samples.
inline io::ImageryInfo frame_over(const io::TerrainInfo& terrain, int ratio) {
    io::ImageryInfo frame;
    frame.west_m = terrain.min_east_m();
    frame.north_m = terrain.max_north_m();
    frame.spacing_x_m = terrain.spacing_x_m / ratio;
    frame.spacing_y_m = terrain.spacing_y_m / ratio;
    frame.width = (terrain.width - 1) * ratio;
    frame.height = (terrain.height - 1) * ratio;
    return frame;
}

// Gives the store at `directory` that imagery, in place of any that it has.
inline void add_imagery(const std::filesystem::path& directory, build::TexelRows& rows, int workers,
                        build::ImageEncoder& encoder) {
    auto update = io::StoreUpdate::begin(directory, io::Replace::existing);
    if (!update) FAIL(update.error().message);
    auto writer = io::ImageryWriter::create(update->directory(), update->scratch(), rows.info().grid());
    REQUIRE(writer);
    jobs::JobSystemOptions options;
    options.workers = workers;
    jobs::JobSystem jobs(options);
    const auto built = build::build_tiles({rows, encoder, jobs, {}}, *writer);
    if (!built) FAIL(built.error().message);
    io::ImageryInfo info = rows.info();
    REQUIRE(writer->finish(info));
    const auto finished = update->finish(info);
    if (!finished) FAIL(finished.error().message);
}

inline void add_imagery(const std::filesystem::path& directory, build::TexelRows& rows, int workers = 1) {
    add_imagery(directory, rows, workers, *build::make_cpu_encoder());
}

// What an imagery layer is on the disk.
inline std::string imagery_files(const std::filesystem::path& directory) {
    std::string all;
    for (const char* name : {"imagery.bin", "imagery.tiles", "terrain.json"}) {
        std::ifstream in(directory / name, std::ios::binary);
        all += std::string(std::istreambuf_iterator<char>(in), {});
    }
    return all;
}

// Noise, some of it without imagery.
inline MemoryTexels::Colour pierced_noise(std::int64_t width, std::int64_t height, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<build::Texel> texels(static_cast<std::size_t>(width * height));
    for (build::Texel& texel : texels) {
        const auto bits = random();
        texel = {static_cast<std::uint8_t>(bits), static_cast<std::uint8_t>(bits >> 8),
                 static_cast<std::uint8_t>(bits >> 16), bits >> 24 < 9 ? std::uint8_t{0} : build::kOpaque};
    }
    return [texels = std::move(texels), width](std::int64_t x, std::int64_t y) {
        return texels[static_cast<std::size_t>(y * width + x)];
    };
}

// A node's tile, read and unpacked.
inline std::vector<io::Bc1Block> read_tile(const io::Store& store, io::NodeId node) {
    std::vector<std::uint8_t> bytes;
    const auto read = store.read_payload(io::Layer::imagery, node, bytes);
    if (!read) FAIL(read.error().message);
    std::vector<io::Bc1Block> blocks(io::kImageryBlockCount);
    io::ImageryScratch scratch;
    REQUIRE(io::decode_imagery(bytes, scratch, std::as_writable_bytes(std::span(blocks))));
    return blocks;
}

}  // namespace ridgeline::test
