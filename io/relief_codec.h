// A relief as it lies in the mesh payload, behind the mesh.
//
// Everything is kept as its difference from what the node's heights tile leads to expect: a chain vertex
// stands a little under the sample at its place, a maximum at or over the greatest sample of its cell.
// Decoding needs the tile for the mask and normals anyway. Pure functions; any thread.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ridgeline/base/result.h"
#include "ridgeline/io/heights_tile.h"
#include "ridgeline/io/relief.h"

namespace ridgeline::io {

// Appends the relief, whose chain heights are codes of chain_step. Of the record, its bounds count.
void encode_relief(ReliefView relief, const NodeRecord& record, const HeightsTile& heights,
                   std::vector<std::uint8_t>& payload);
// payload: no more than the relief. Any damage is an Error, or another relief of possible values.
Result<void> decode_relief(std::span<const std::uint8_t> payload, const NodeRecord& record,
                           const HeightsTile& heights, ReliefView relief);

}  // namespace ridgeline::io
