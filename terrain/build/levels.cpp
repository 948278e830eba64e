#include "ridgeline/build/levels.h"

#include <algorithm>
#include <bit>

#include "ridgeline/base/contract.h"

namespace ridgeline::build {

VertexKind vertex_kind(std::int64_t x, std::int64_t y) {
    const auto both = static_cast<std::uint64_t>(x) | static_cast<std::uint64_t>(y);
    if (both == 0) return {VertexKind::kTopScale, false};
    const int scale = std::countr_zero(both);
    return {scale, (((x >> scale) & (y >> scale)) & 1) != 0};
}

Levels::Levels(const io::Grid& grid, const std::vector<std::uint8_t>& thresholds)
    : thresholds_(thresholds),
      finest_(grid.finest()),
      log_quads_(std::countr_zero(static_cast<unsigned>(grid.quads()))) {
    RIDGELINE_CHECK(static_cast<int>(thresholds.size()) == grid.levels());
    RIDGELINE_CHECK(std::is_sorted(thresholds.rbegin(), thresholds.rend()));
    for (int code = 0; code < kErrorCodes; ++code) {
        std::uint8_t& level = of_code_[static_cast<std::size_t>(code)];
        while (level < thresholds.size() && code <= thresholds[level]) ++level;
    }
}

std::uint8_t Levels::of_place(VertexKind kind) const {
    // Forced where the scale is at least half the node's extent, for centres a quarter: extents are
    // 2^(log_quads + finest - level).
    const int reach = kind.scale + (kind.centre ? 2 : 1);
    const int level = std::max(0, log_quads_ + finest_ - reach);
    return static_cast<std::uint8_t>(std::min(level, static_cast<int>(levels())));
}

void Levels::translate(const std::uint8_t* codes, std::size_t count, std::uint8_t* levels) const {
    // In pieces that stay in the first-level cache while every threshold passes over them.
    constexpr std::size_t kPiece = 4096;
    std::uint8_t sums[kPiece];
    for (std::size_t begin = 0; begin < count; begin += kPiece) {
        const std::size_t piece = std::min(kPiece, count - begin);
        std::fill_n(sums, piece, std::uint8_t{0});
        for (const std::uint8_t threshold : thresholds_)
            for (std::size_t i = 0; i < piece; ++i)
                sums[i] = static_cast<std::uint8_t>(sums[i] + (codes[begin + i] <= threshold ? 1 : 0));
        std::copy_n(sums, piece, levels + begin);
    }
}

}  // namespace ridgeline::build
