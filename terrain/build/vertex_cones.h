// The normal cones of a block's vertices, row by row.
//
// Pure function; any thread.
#pragma once

#include <cstdint>

#include "ridgeline/build/phases.h"
#include "ridgeline/build/vertex_metric.h"

namespace ridgeline::build {

// Raises the codes of one scale's vertices to those of their cones, where all nine samples about the vertex
// lie in the lattice and are valid. heights: at most kErrorCells / 2 cells a side. flags: sample flags, or
// null where every sample is valid.
void raise_by_cones(const Phases<std::int32_t>& heights, const Phases<std::uint8_t>* flags,
                    const ConeScale& cones, Phases<std::uint8_t>& codes);

}  // namespace ridgeline::build
