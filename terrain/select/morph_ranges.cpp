// Literature: morphing by distance between a node's switching distance and its parent's, B' = B - w * dB
// (gpu-quadtree paper, eq. 4-6; chunked LOD; CDLOD). Those morph a node's border with its inside and close
// what opens by skirts, degenerate triangles or equal ranges everywhere. Here every piece of a border (half
// sides, midpoints, inner half lines, centre) has a ramp of its own, made of numbers that all its nodes
// share, so that nothing opens:
//
//   half a side, same level beyond   the nearer end, the farther start and the larger fade of the two nodes
//   ..., coarser beyond              1: the parent's surface, which the coarser mesh draws there (with its fans)
//   ..., finer beyond                0: own heights, through which the fans run and at which the finer side arrives
//   midpoint of a side               0 as soon as it is a corner of anything drawn, for corners never move
//   inner half lines, centre         0 where a child draws a quarter beside them
#include "ridgeline/select/morph_ranges.h"

#include <algorithm>
#include <cmath>

namespace ridgeline::select {
namespace {

using io::Side;
namespace vertex_class = io::vertex_class;

constexpr MorphParameters kOwn{0.0f, 0.0f, 0.0f};
constexpr MorphParameters kParent{0.0f, 1.0f, 0.0f};

MorphParameters ramp(const MorphSpan& span) {
    if (std::isinf(span.end_m)) return kOwn;
    if (!(span.end_m > 0.0)) return kParent;
    // A third of the distance is enough for a morph not to be noticed; a tenth is the least that is no jump.
    const double start_m = std::clamp(span.reach_m, span.end_m * (2.0 / 3.0), span.end_m * 0.9);
    const double scale = 1.0 / (span.end_m - start_m);
    // A node larger than its ranges splits while its far vertices are past their start: as the split comes
    // near, the ramp moves out of the node's reach, so that all of it stands at its own heights when its
    // children appear.
    const double moved_m = start_m + (1.0 - span.rest) * std::max(span.far_m - start_m, 0.0);
    return {static_cast<float>(scale), static_cast<float>(-moved_m * scale), span.fade};
}

MorphParameters half_side(Beyond beyond, const MorphParameters& own, const MorphParameters& shared) {
    switch (beyond) {
        case Beyond::nothing:
            return own;
        case Beyond::coarser:
            return kParent;
        case Beyond::same:
            return shared;
        case Beyond::finer:
            break;
    }
    return kOwn;
}

// The two quarters at a side, as bits.
constexpr unsigned kSideQuarters[io::kSides] = {0b0101, 0b1010, 0b0011, 0b1100};
// The two quarters beside an inner half line: north, south, west, east.
constexpr unsigned kLineQuarters[4] = {0b0011, 0b1100, 0b0101, 0b1010};

}  // namespace

MorphSpan shared_span(const MorphSpan& a, const MorphSpan& b) {
    return {std::min(a.end_m, b.end_m), std::max(a.reach_m, b.reach_m), std::max(a.far_m, b.far_m),
            std::min(a.rest, b.rest), std::max(a.fade, b.fade)};
}

MorphTable morph_table(const MorphSpan& own_span, const MorphNeighbours& neighbours) {
    MorphTable table;
    const MorphParameters own = ramp(own_span);
    const unsigned children = neighbours.quarters_of_children;
    table[vertex_class::kInterior] = own;
    for (int s = 0; s < io::kSides; ++s) {
        const auto side = static_cast<Side>(s);
        const auto at = static_cast<std::size_t>(s);
        const auto& beyond = neighbours.beyond[at];
        const MorphParameters shared = ramp(shared_span(own_span, neighbours.span[at]));
        for (int half = 0; half < 2; ++half)
            table[static_cast<std::size_t>(vertex_class::outer(side, half))] =
                half_side(beyond[static_cast<std::size_t>(half)], own, shared);
        const bool corner_of_finer =
            beyond[0] == Beyond::finer || beyond[1] == Beyond::finer || (children & kSideQuarters[s]) != 0;
        table[static_cast<std::size_t>(vertex_class::midpoint(side))] =
            corner_of_finer ? kOwn : half_side(beyond[0], own, shared);
    }
    for (int line = 0; line < 4; ++line)
        table[static_cast<std::size_t>(vertex_class::inner(line))] =
            (children & kLineQuarters[line]) != 0 ? kOwn : own;
    table[vertex_class::kCentre] = children != 0 ? kOwn : own;
    return table;
}

}  // namespace ridgeline::select
