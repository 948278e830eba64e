// Which of a build's finest tiles tell of the source's roughness: a few hundred, spread over the terrain, the same whatever
// the number of threads. Keeps them packed, about three megabytes. One thread at a time.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "ridgeline/base/result.h"
#include "ridgeline/io/detail_info.h"
#include "ridgeline/io/grid.h"
#include "ridgeline/io/terrain_info.h"

namespace ridgeline::build {

class DetailWindows {
  public:
    explicit DetailWindows(const io::Grid& grid);

    // A tile's payload, in any order; what is not wanted is passed over.
    void offer(io::NodeId node, std::span<const std::uint8_t> payload);
    // Of the tiles whose samples are all valid. info: the store's, but for the detail.
    Result<io::DetailInfo> calibrate(const io::TerrainInfo& info);

  private:
    bool is_wanted(io::NodeId node) const;

    io::Grid grid_;
    std::uint64_t one_in_;
    std::vector<std::pair<std::int64_t, std::vector<std::uint8_t>>>
        tiles_;  // by linear place, sorted at the end
};

}  // namespace ridgeline::build
