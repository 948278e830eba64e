// The whole raster as packed samples in a scratch file: written once from north to south, read in windows.
//
// Rows of little relief take two bytes a sample. Plain positioned reads and writes, no memory map: the page
// cache holds what fits, and none of it counts as the builder's memory. Thread rules: one thread at a time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "ridgeline/base/result.h"
#include "ridgeline/build/blocks.h"
#include "ridgeline/build/samples.h"
#include "ridgeline/io/output_file.h"

namespace ridgeline::build {

struct SampleStatistics {
    std::int64_t valid = 0;
    std::int32_t min_quanta = kMaxQuanta;
    std::int32_t max_quanta = -kMaxQuanta;
};

class ScratchRaster {
  public:
    static Result<ScratchRaster> create(const std::filesystem::path& path, std::int64_t width,
                                        std::int64_t height);

    // The next rows, kNoHeight where there is no height; their number follows from the span.
    Result<void> append(std::span<const std::int32_t> quanta);
    // Rows that can be read: all but the last appended one, whose cells need the row below, until all are
    // there.
    std::int64_t readable_rows() const { return static_cast<std::int64_t>(rows_.size()); }
    const SampleStatistics& statistics() const { return statistics_; }

    // The window of a block, kWindow rows of kWindow packed samples; what lies outside the raster is left as
    // it was.
    Result<void> read_window(io::LatticePoint block_origin, std::span<std::int32_t> window) const;

  private:
    // Where a row lies, and how: words of 16 bits above the row's least height, where those suffice.
    struct Row {
        std::uint64_t offset = 0;
        std::int32_t base = 0;
        std::int32_t word_bytes = 4;
    };

    ScratchRaster(io::OutputFile file, std::int64_t width, std::int64_t height)
        : file_(std::move(file)), width_(width), height_(height) {}
    void encode_row(std::span<const std::int32_t> packed);
    Result<void> read_row(const Row& row, std::int64_t first, std::span<std::int32_t> packed) const;

    io::OutputFile file_;
    std::int64_t width_, height_;
    std::vector<Row> rows_;
    // Packed rows that wait for the row below: at first the last row of the append before.
    std::vector<std::int32_t> waiting_;
    std::vector<std::byte> encoded_;
    std::vector<std::uint16_t> narrow_;
    SampleStatistics statistics_;
};

}  // namespace ridgeline::build
