#include "ridgeline/build/scratch_raster.h"

#include <algorithm>
#include <array>
#include <cstring>

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
    const std::size_t before = waiting_.size();
    waiting_.resize(before + quanta.size());
    for (std::size_t at = 0; at < quanta.size(); at += width)
        pack_row(&quanta[at], width_, &waiting_[before + at], statistics_);
    std::size_t ready = waiting_.size() - width;
    for (std::size_t at = 0; at < ready; at += width)
        mark_cells(&waiting_[at], &waiting_[at + width], width_);
    const auto last = readable_rows() + static_cast<std::int64_t>(ready / width) + 1;
    RIDGELINE_CHECK(last <= height_);
    if (last == height_) ready = waiting_.size();
    encoded_.clear();
    for (std::size_t at = 0; at < ready; at += width) encode_row(std::span(waiting_).subspan(at, width));
    const auto written = file_.append(encoded_);
    if (!written) return written.error();
    waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(ready));
    return {};
}

void ScratchRaster::encode_row(std::span<const std::int32_t> packed) {
    std::int32_t least = sample::pack(kMaxQuanta), greatest = sample::pack(-kMaxQuanta);
    for (const std::int32_t word : packed) {
        const bool valid = (word & sample::kValid) != 0;
        least = std::min(least, valid ? word : sample::pack(kMaxQuanta));
        greatest = std::max(greatest, valid ? word : sample::pack(-kMaxQuanta));
    }
    const std::int32_t base = std::min(least, greatest) & ~sample::kFlags;
    const bool narrow =
        greatest <= least || std::int64_t{greatest} - base <= std::numeric_limits<std::uint16_t>::max();
    rows_.push_back({file_.size() + encoded_.size(), narrow ? base : 0, narrow ? 2 : 4});
    const std::size_t at = encoded_.size();
    encoded_.resize(at + packed.size() * (narrow ? sizeof(std::uint16_t) : sizeof(std::int32_t)));
    if (!narrow) {
        std::memcpy(&encoded_[at], packed.data(), packed.size_bytes());
        return;
    }
    narrow_.resize(packed.size());
    for (std::size_t i = 0; i < packed.size(); ++i)
        narrow_[i] = static_cast<std::uint16_t>((packed[i] - base) & -(packed[i] & sample::kValid));
    std::memcpy(&encoded_[at], narrow_.data(), packed.size() * sizeof(std::uint16_t));
}

Result<void> ScratchRaster::read_row(const Row& row, std::int64_t first,
                                     std::span<std::int32_t> packed) const {
    const std::uint64_t offset = row.offset + static_cast<std::uint64_t>(first * row.word_bytes);
    if (row.word_bytes == 4) return file_.read_at(offset, std::as_writable_bytes(packed));
    std::array<std::uint16_t, kWindow> words;
    const auto narrow = std::span(words).first(packed.size());
    RIDGELINE_TRY(file_.read_at(offset, std::as_writable_bytes(narrow)));
    for (std::size_t i = 0; i < packed.size(); ++i) packed[i] = row.base + narrow[i];
    return {};
}

Result<void> ScratchRaster::read_window(io::LatticePoint block_origin, std::span<std::int32_t> window) const {
    const std::int64_t west = block_origin.x - kWindowApron, north = block_origin.y - kWindowApron;
    const std::int64_t first_x = std::max<std::int64_t>(west, 0), last_x = std::min(west + kWindow, width_);
    const std::int64_t first_y = std::max<std::int64_t>(north, 0),
                       last_y = std::min(north + kWindow, height_);
    RIDGELINE_CHECK(last_y <= readable_rows());
    for (std::int64_t y = first_y; y < last_y; ++y) {
        const auto row = window.subspan(static_cast<std::size_t>((y - north) * kWindow + first_x - west),
                                        static_cast<std::size_t>(last_x - first_x));
        RIDGELINE_TRY(read_row(rows_[static_cast<std::size_t>(y)], first_x, row));
    }
    return {};
}

}  // namespace ridgeline::build
