// A heights tile: the samples of one node at its level's spacing, with an apron, and what of them is valid.
//
// (quads+1)^2 samples shared with the neighbours' borders, and kApron samples beyond on every side: enough
// for normals on the border and for the subdivision of detail synthesis. Beyond the raster the nearest sample
// repeats, invalid. Heights are integers in the store's quantum; invalid samples carry a smooth fill.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ridgeline/base/result.h"

namespace ridgeline::io {

struct HeightsTile {
    static constexpr int kApron = 3;

    int quads = 64;
    bool all_valid = true;
    // stride() rows of stride() samples, north-western first.
    std::vector<std::int32_t> quanta;
    // One byte a sample (0 or 1), as quanta; empty where all are valid.
    std::vector<std::uint8_t> sample_valid;
    // One byte a cell, quads x quads: valid if any source cell under it is; empty where all are valid.
    std::vector<std::uint8_t> cell_valid;

    int stride() const { return quads + 1 + 2 * kApron; }
    // column and row count from the node's corner, from -kApron to quads + kApron.
    std::size_t at(int column, int row) const {
        const int place = (row + kApron) * stride() + column + kApron;
        return static_cast<std::size_t>(place);
    }
};

// Planar prediction, byte planes, zstd; appends to `payload`. Rates: docs/benchmarks.md.
void encode_heights(const HeightsTile& tile, std::vector<std::uint8_t>& payload);
// Reuses the tile's memory. Fails on any damaged payload, never reads past it.
Result<void> decode_heights(std::span<const std::uint8_t> payload, int quads, HeightsTile& tile);

}  // namespace ridgeline::io
