// Morph parameters of one draw entry: from the distances at which it and its neighbours switch to eighteen
// ramps. Internal to the room; pure functions.
#pragma once

#include <array>

#include "ridgeline/io/chunk.h"
#include "ridgeline/select/selection.h"

namespace ridgeline::select {

// What a node's distances say of its morph.
struct MorphSpan {
    double end_m = 0.0;    // the distance at which its parent takes over; infinite at level 0
    double reach_m = 0.0;  // no vertex may have begun to move this near: split distance + diagonal
    double far_m = 0.0;    // no vertex is farther from the eye
    double rest = 1.0;     // 0 where its children are about to take over, 1 where its parent is
    float fade = 0.0f;
};
// What both nodes of an edge agree on.
MorphSpan shared_span(const MorphSpan& a, const MorphSpan& b);

// Who is on the other side of half a side, or of a quarter's inner side.
enum class Beyond {
    nothing,  // the terrain's end
    coarser,  // the node's parent's level
    same,     // the neighbour itself
    finer,    // a child of the neighbour
};

struct MorphNeighbours {
    // By side and half.
    std::array<std::array<Beyond, 2>, io::kSides> beyond{};
    // By side; read where the same level meets.
    std::array<MorphSpan, io::kSides> span{};
    // Quarters of the node itself that a child draws, as bits.
    unsigned quarters_of_children = 0;
};

MorphTable morph_table(const MorphSpan& own, const MorphNeighbours& neighbours);

}  // namespace ridgeline::select
