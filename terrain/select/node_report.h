// What became of each place of the terrain in one selection, for whoever looks over its shoulder: maps,
// figures, tests.
//
// Plain values. Together the quarters of all reports cover what of the terrain has data exactly once.
#pragma once

#include <cstdint>

#include "ridgeline/io/node_id.h"

namespace ridgeline::select {

enum class NodeFate : std::uint8_t {
    drawn,
    drawn_in_part,  // some of its quarters are hidden or out of view
    stands_in,      // drawn, whole or in part, where finer nodes are asked for: they are missing or held back
    hidden,
    hidden_missing,
    missing,  // in view, and nothing is drawn there
    out_of_view,
};
constexpr int kNodeFates = 7;

// A leaf of the drawn tree, or those quarters of a node that no child draws.
struct NodeReport {
    io::NodeId node;
    NodeFate fate = NodeFate::drawn;
    std::uint8_t quarters = 0;  // which quarters it tells of, as bits
    std::uint8_t in_view = 0;   // ... of these, which touch the picture
    std::uint8_t drawn = 0;     // ... of those, which are drawn
    bool resident = false;
    bool ahead = false;  // not drawn, but may be seen from where the eye may be soon
};

}  // namespace ridgeline::select
