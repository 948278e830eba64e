// The whole raster as packed samples in a scratch file: written once from north to south, read in windows.
//
// Plain positioned reads and writes, no memory map: the page cache holds what fits, and none of it counts as
// the builder's memory. Thread rules: one thread at a time.
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
    std::int64_t readable_rows() const { return readable_rows_; }
    const SampleStatistics& statistics() const { return statistics_; }

    // The window of a block, kWindow rows of kWindow packed samples; what lies outside the raster is left as
    // it was.
    Result<void> read_window(io::LatticePoint block_origin, std::span<std::int32_t> window) const;

  private:
    ScratchRaster(io::OutputFile file, std::int64_t width, std::int64_t height)
        : file_(std::move(file)), width_(width), height_(height) {}

    io::OutputFile file_;
    std::int64_t width_, height_;
    std::int64_t readable_rows_ = 0;
    // Packed rows without cells: at first the last row of the append before.
    std::vector<std::int32_t> rows_;
    SampleStatistics statistics_;
};

}  // namespace ridgeline::build
