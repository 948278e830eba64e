#include "ridgeline/build/scratch_raster.h"

#include <algorithm>

namespace ridgeline::build {
namespace {

void pack_row(const std::int32_t* quanta, std::int64_t width, std::int32_t* packed,
              SampleStatistics& statistics) {
    std::int32_t valid_samples = 0, least = kMaxQuanta, greatest = -kMaxQuanta;
    for (std::int64_t i = 0; i < width; ++i) {
        const std::int32_t valid = quanta[i] != kNoHeight ? 1 : 0;
        const std::int32_t height = quanta[i] & -valid;
        packed[i] = sample::pack(height) | valid;
        valid_samples += valid;
        least = std::min(least, valid != 0 ? height : kMaxQuanta);
        greatest = std::max(greatest, valid != 0 ? height : -kMaxQuanta);
    }
    statistics.valid += valid_samples;
    statistics.min_quanta = std::min(statistics.min_quanta, least);
    statistics.max_quanta = std::max(statistics.max_quanta, greatest);
}

// Bit 1 of a sample is set from bits 0 alone, so rows can be done in place and in any order.
void mark_cells(std::int32_t* row, const std::int32_t* below, std::int64_t width) {
    for (std::int64_t i = 0; i + 1 < width; ++i)
        row[i] |= (row[i] & row[i + 1] & below[i] & below[i + 1] & sample::kValid) * sample::kCellValid;
}

}  // namespace

Result<ScratchRaster> ScratchRaster::create(const std::filesystem::path& path, std::int64_t width,
                                            std::int64_t height) {
    auto file = io::OutputFile::create(path);
    if (!file) return file.error();
    return ScratchRaster(std::move(*file), width, height);
}

Result<void> ScratchRaster::append(std::span<const std::int32_t> quanta) {
    const auto width = static_cast<std::size_t>(width_);
    const std::size_t waiting = rows_.size();
    rows_.resize(waiting + quanta.size());
    for (std::size_t at = 0; at < quanta.size(); at += width)
        pack_row(&quanta[at], width_, &rows_[waiting + at], statistics_);
    std::size_t ready = rows_.size() - width;
    for (std::size_t at = 0; at < ready; at += width) mark_cells(&rows_[at], &rows_[at + width], width_);
    const auto last = readable_rows_ + static_cast<std::int64_t>(ready / width) + 1;
    RIDGELINE_CHECK(last <= height_);
    if (last == height_) ready = rows_.size();
    const auto written = file_.append(std::as_bytes(std::span(rows_).first(ready)));
    if (!written) return written.error();
    readable_rows_ += static_cast<std::int64_t>(ready / width);
    rows_.erase(rows_.begin(), rows_.begin() + static_cast<std::ptrdiff_t>(ready));
    return {};
}

Result<void> ScratchRaster::read_window(io::LatticePoint block_origin, std::span<std::int32_t> window) const {
    const std::int64_t west = block_origin.x - kWindowApron, north = block_origin.y - kWindowApron;
    const std::int64_t first_x = std::max<std::int64_t>(west, 0), last_x = std::min(west + kWindow, width_);
    const std::int64_t first_y = std::max<std::int64_t>(north, 0),
                       last_y = std::min(north + kWindow, height_);
    RIDGELINE_CHECK(last_y <= readable_rows_);
    for (std::int64_t y = first_y; y < last_y; ++y) {
        const auto row = window.subspan(static_cast<std::size_t>((y - north) * kWindow + first_x - west),
                                        static_cast<std::size_t>(last_x - first_x));
        const auto offset =
            static_cast<std::uint64_t>((y * width_ + first_x) * std::int64_t{sizeof(std::int32_t)});
        RIDGELINE_TRY(file_.read_at(offset, std::as_writable_bytes(row)));
    }
    return {};
}

}  // namespace ridgeline::build
