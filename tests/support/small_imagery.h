// Pictures in memory as an imagery layer, by the builder's own way through them.
#pragma once

#include <doctest/doctest.h>

#include <functional>

#include "ridgeline/build/imagery/imagery_builder.h"
#include "ridgeline/io/imagery_writer.h"
#include "ridgeline/io/store.h"
#include "ridgeline/io/store_update.h"

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
    std::vector<std::string> findings() const override { return {}; }

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
inline void add_imagery(const std::filesystem::path& directory, build::TexelRows& rows, int workers = 1) {
    auto update = io::StoreUpdate::begin(directory, io::Replace::existing);
    if (!update) FAIL(update.error().message);
    auto writer = io::ImageryWriter::create(update->directory(), update->scratch(), rows.info().grid());
    REQUIRE(writer);
    jobs::JobSystemOptions options;
    options.workers = workers;
    jobs::JobSystem jobs(options);
    const auto encoder = build::make_cpu_encoder();
    const auto built = build::build_tiles({rows, *encoder, jobs, {}}, *writer);
    if (!built) FAIL(built.error().message);
    io::ImageryInfo info = rows.info();
    REQUIRE(writer->finish(info));
    const auto finished = update->finish(info);
    if (!finished) FAIL(finished.error().message);
}

// A colour of a decoded tile's mip 0, column and row from the content's corner, −4 to 259.
inline build::Texel texel_of(std::span<const io::Bc1Block> blocks, int column, int row) {
    const int x = column + io::kImageryGutter, y = row + io::kImageryGutter;
    const io::Bc1Block& block = blocks[static_cast<std::size_t>(y / 4 * io::kImageryBlocks + x / 4)];
    const auto widen = [](std::uint16_t c) {
        const int r = c >> 11, g = c >> 5 & 63, b = c & 31;
        return std::array{r << 3 | r >> 2, g << 2 | g >> 4, b << 3 | b >> 2};
    };
    const auto first = widen(block.first), second = widen(block.second);
    const std::uint32_t index = block.indices >> (2 * (y % 4 * 4 + x % 4)) & 3;
    const bool holes = block.first <= block.second;
    if (holes && index == 3) return {};
    const auto mixed = [&](std::size_t i) {
        const int a = first[i], b = second[i];
        const int value = index == 0   ? a
                          : index == 1 ? b
                          : holes      ? (a + b) / 2
                          : index == 2 ? (2 * a + b) / 3
                                       : (a + 2 * b) / 3;
        return static_cast<std::uint8_t>(value);
    };
    return {mixed(0), mixed(1), mixed(2), build::kOpaque};
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
