// The tiles of a terrain's made ground, each made from its parent when it is asked for, down from the source's own tile,
// which whoever asks knows where to find; of each octave those that were used last are kept.
//
// One thread at a time.
#pragma once

#include <cstddef>
#include <vector>

#include "ridgeline/base/least_recent_cache.h"
#include "ridgeline/base/result.h"
#include "ridgeline/detail/detail_tile.h"
#include "ridgeline/detail/finer_ground.h"

namespace ridgeline::detail {

// Where the source's tiles come from; what it gives never changes.
class RootSource {
  public:
    // Fills a tile of the source's finest level, as make_root(). False where there is none.
    virtual Result<bool> fill_root(io::NodeId node, DetailTile& root) = 0;

  protected:
    ~RootSource() = default;
};

class MadeGround {
  public:
    // finest: level of the source's. kept_tiles: of each octave, and of the source; at least one.
    MadeGround(FinerGround ground, int finest, std::size_t kept_tiles);

    const FinerGround& ground() const { return ground_; }
    // Of the source's finest level, or below it. Null where the source has no tile; until the next call.
    Result<const DetailTile*> tile(io::NodeId node, RootSource& source);

  private:
    Result<const DetailTile*> root(io::NodeId node, RootSource& source);

    FinerGround ground_;
    int finest_;
    // By octave: a tile's own ancestors stay while it is made.
    std::vector<LeastRecentCache<DetailTile>> tiles_;
};

}  // namespace ridgeline::detail
