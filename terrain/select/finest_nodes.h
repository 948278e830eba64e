// The source's finest nodes about the eye, in view or not, hidden or not: where ground finer than the source may be
// drawn. Stateless; any thread.
#pragma once

#include <span>
#include <vector>

#include "ridgeline/io/node_record.h"
#include "ridgeline/io/terrain_info.h"
#include "ridgeline/select/view.h"

namespace ridgeline::select {

// Those with data whose boxes, as they are drawn, lie nearer to the view's eye than `metres`; in the grid's order.
// records: as in Store::records(). `nodes` is filled anew, and keeps its memory.
void find_finest_within(const io::TerrainInfo& info, std::span<const io::NodeRecord> records,
                        const View& view, double metres, std::vector<io::NodeId>& nodes);

}  // namespace ridgeline::select
