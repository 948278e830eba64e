// What a chunk or a relief is decoded with, from a fuzz input: a heights tile and a record.
#pragma once

#include <algorithm>

#include "fuzz/input.h"
#include "ridgeline/io/heights_tile.h"
#include "ridgeline/io/node_record.h"

namespace ridgeline::fuzz {

// A tile of any heights: two numbers of the input make a pattern of them.
inline io::HeightsTile heights_of(Input& input, int quads) {
    io::HeightsTile tile;
    tile.quads = quads;
    const std::uint32_t first = input.word(), step = input.word();
    const auto samples = static_cast<std::size_t>(tile.stride()) * static_cast<std::size_t>(tile.stride());
    for (std::size_t i = 0; i < samples; ++i)
        tile.quanta.push_back(static_cast<std::int32_t>(first + step * static_cast<std::uint32_t>(i % 61)));
    tile.all_valid = (step & 1u) == 0;
    if (tile.all_valid) return tile;
    tile.sample_valid.resize(samples, 1);
    tile.cell_valid.resize(static_cast<std::size_t>(quads) * static_cast<std::size_t>(quads));
    for (std::size_t i = 0; i < tile.cell_valid.size(); ++i) tile.cell_valid[i] = i % 7 == 0 ? 0 : 1;
    return tile;
}

// A record's bounds, in the order that a store holds them to.
inline void set_bounds(Input& input, io::NodeRecord& record) {
    const std::int32_t one = input.signed_word(), other = input.signed_word();
    record.min_quanta = std::min(one, other);
    record.max_quanta = std::max(one, other);
    record.flags = io::NodeRecord::kHasData;
}

}  // namespace ridgeline::fuzz
