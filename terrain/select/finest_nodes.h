// The source's finest nodes about the eye, in view or not, hidden or not: where ground finer than the source may be
// drawn. Stateless; any thread.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "ridgeline/io/node_record.h"
#include "ridgeline/io/terrain_info.h"
#include "ridgeline/select/view.h"

namespace ridgeline::select {

// How near a node must be: least_m, or farther by its own error, as far as most_m.
struct NodeReach {
    double least_m = 0.0, most_m = 0.0;
    double by_error = 0.0;  // metres a metre of it, without exaggeration
};

struct NearNode {
    io::NodeId node;
    double distance_m = 0.0;  // from the eye to its box as it is drawn

    friend bool operator==(const NearNode&, const NearNode&) = default;
};

// Those with data, nearest first, `most` of them at most. records: as in Store::records(). `nodes` is filled anew, and
// keeps its memory.
void find_finest_within(const io::TerrainInfo& info, std::span<const io::NodeRecord> records,
                        const View& view, const NodeReach& reach, std::size_t most,
                        std::vector<NearNode>& nodes);

}  // namespace ridgeline::select
