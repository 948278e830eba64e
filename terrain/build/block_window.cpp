#include "ridgeline/build/block_window.h"

#include <algorithm>

namespace ridgeline::build {

void BlockWindow::unpack(const io::Grid& grid, io::LatticePoint block_origin,
                         std::span<const std::int32_t> packed) {
    constexpr auto kSamples = static_cast<std::size_t>(kWindow) * kWindow;
    frame_ = WindowFrame(grid, block_origin);
    quanta_.resize(kSamples);
    flags_.assign(kSamples, 0);
    std::int32_t all = sample::kValid;
    for (int y = frame_.first_y; y < frame_.last_y; ++y)
        for (int x = frame_.first_x; x < frame_.last_x; ++x) {
            const auto i = static_cast<std::size_t>(y * kWindow + x);
            quanta_[i] = sample::quanta(packed[i]);
            flags_[i] = static_cast<std::uint8_t>(packed[i] & sample::kFlags);
            all &= packed[i];
        }
    has_voids_ = (all & sample::kValid) == 0;
    const bool inside =
        frame_.first_x == 0 && frame_.first_y == 0 && frame_.last_x == kWindow && frame_.last_y == kWindow;
    complete_ = inside && !has_voids_;
}

void BlockWindow::pad() {
    for (int y = frame_.first_y; y < frame_.last_y; ++y) {
        const auto row = quanta_.begin() + y * kWindow;
        std::fill(row, row + frame_.first_x, row[frame_.first_x]);
        std::fill(row + frame_.last_x, row + kWindow, row[frame_.last_x - 1]);
    }
    const auto row = [&](int y) { return quanta_.begin() + y * kWindow; };
    for (int y = 0; y < frame_.first_y; ++y) std::copy_n(row(frame_.first_y), kWindow, row(y));
    for (int y = frame_.last_y; y < kWindow; ++y) std::copy_n(row(frame_.last_y - 1), kWindow, row(y));
}

}  // namespace ridgeline::build
