#include "ridgeline/build/block_levels.h"

namespace ridgeline::build {
namespace {

constexpr int kEighthSide = kErrorCells / 8 + 1;

void find_eighth(const CoarseLattice& lattice, const Levels& levels, io::LatticePoint origin,
                 std::vector<std::uint8_t>& eighth) {
    eighth.clear();
    for (int row = 0; row < kEighthSide; ++row)
        for (int column = 0; column < kEighthSide; ++column) {
            const std::int64_t x = origin.x - kErrorApron + 8 * column, y = origin.y - kErrorApron + 8 * row;
            const bool outside = x < 0 || y < 0;
            eighth.push_back(outside ? levels.levels() : lattice.level(levels, x, y));
        }
}

void merge_into(const std::vector<std::uint8_t>& even, const Phases<std::uint8_t>& phases,
                std::vector<std::uint8_t>& points) {
    const auto side = static_cast<std::size_t>(2 * phases.cells + 1);
    points.resize(side * side);
    merge(even.data(), phases, points.data());
}

}  // namespace

void BlockLevels::find(const VertexErrors& errors, const CoarseLattice& lattice, const Levels& levels,
                       io::LatticePoint block_origin) {
    for (int scale = 0; scale < kFineScales; ++scale) {
        const Phases<std::uint8_t>& codes = errors.codes[scale];
        phases[scale].resize(codes.cells);
        levels.translate(codes.x.data(), codes.x.size(), phases[scale].x.data());
        levels.translate(codes.y.data(), codes.y.size(), phases[scale].y.data());
        levels.translate(codes.centre.data(), codes.centre.size(), phases[scale].centre.data());
    }
    find_eighth(lattice, levels, block_origin, eighth);
    merge_into(eighth, phases[2], quarter_);
    merge_into(quarter_, phases[1], half_);
    merge_into(half_, phases[0], dense);
}

}  // namespace ridgeline::build
