// Decoded chunks straight from a store, for whoever needs a few of them and no pager: queries, tools,
// benches.
//
// Reads block. One thread at a time per reader; the store outlives it.
#pragma once

#include <cstdint>
#include <vector>

#include "ridgeline/io/store.h"

namespace ridgeline::io {

// A chunk with its memory; may be moved and used again.
struct OwnedChunk {
    std::vector<ChunkVertex> block;  // ChunkVertex for its alignment
    ChunkView view;
};

class ChunkReader {
  public:
    explicit ChunkReader(const Store& store) : store_(store) {}

    // The node must have data. What the chunk held before is lost, also where this fails.
    Result<void> read(NodeId node, OwnedChunk& chunk);

  private:
    const Store& store_;
    std::vector<std::uint8_t> bytes_;
    HeightsTile heights_;
    ChunkScratch scratch_;
};

}  // namespace ridgeline::io
