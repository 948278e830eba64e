// The error of every vertex of a block at scales 1, 2 and 4, propagated so that a vertex never has less than
// those that depend on it.
//
// Errors of invalid samples count as none: nothing is drawn there, so the fill costs no triangles; a cone of
// which a sample is invalid counts as none too. Scales of 8 and more go on from here in CoarseLattice.
#pragma once

#include <cstdint>
#include <span>

#include "ridgeline/build/blocks.h"
#include "ridgeline/build/phases.h"
#include "ridgeline/build/vertex_metric.h"

namespace ridgeline::build {

// Errors are exact within kExactApron samples around the block: as far as coarser scales ask for them.
constexpr int kErrorApron = 16;
constexpr int kExactApron = 8;
constexpr int kErrorCells = kBlock + 2 * kErrorApron;
constexpr int kFineScales = 3;  // 1, 2, 4

// One thread's working memory and result.
struct VertexErrors {
    // By scale; heights over the block and kErrorApron around it, and the codes of the vertices (even is
    // unused).
    Phases<std::int32_t> heights[kFineScales];
    Phases<std::uint8_t> codes[kFineScales];
    Phases<std::uint8_t> flags[kFineScales];
};

// Cells of a scale between the errors' first one and the block's.
constexpr int first_cell(int scale) { return kErrorApron >> (scale + 1); }
constexpr int block_cells(int scale) { return kBlock >> (scale + 1); }

// quanta: the block's window. flags: the same of sample flags, or empty where every sample of the window is
// valid.
void find_vertex_errors(std::span<const std::int32_t> quanta, std::span<const std::uint8_t> flags,
                        const VertexMetric& metric, VertexErrors& errors);

}  // namespace ridgeline::build
