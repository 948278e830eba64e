// What the pager reads from: the node records, the two layers' byte sources, and how payloads become a chunk.
//
// A view: whoever made what it refers to (a store, or a test's fake) keeps it alive longer than the pager.
// Everything here is immutable; sources and decoder are called from the I/O thread and from workers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "ridgeline/base/result.h"
#include "ridgeline/io/byte_source.h"
#include "ridgeline/io/chunk.h"
#include "ridgeline/io/chunk_codec.h"
#include "ridgeline/io/grid.h"
#include "ridgeline/io/heights_tile.h"
#include "ridgeline/io/node_record.h"

namespace ridgeline::io {
class Store;
}

namespace ridgeline::pager {

// A node's place in the store's linear order (io::Grid::linear).
using NodeIndex = std::uint32_t;
constexpr NodeIndex kNoNode = 0xffffffffu;

// Working memory of one decode at a time; reused, so that decoding does not allocate in steady state.
struct DecodeScratch {
    io::HeightsTile heights;
    io::ChunkScratch chunk;
};

// Two payloads that passed their checksums, to be decoded into `block`.
struct EncodedTile {
    io::NodeId node;
    const io::NodeRecord* record = nullptr;
    std::span<const std::uint8_t> mesh;
    std::span<const std::uint8_t> heights;
};

class TileDecoder {
  public:
    virtual ~TileDecoder() = default;
    // Writes the chunk into its block, of at least chunk_layout(record).total bytes. Any thread, several at
    // once.
    virtual Result<void> decode(const EncodedTile& tile, DecodeScratch& scratch,
                                std::span<std::byte> block) const = 0;
};

// io::decode_heights and io::decode_chunk.
class ChunkDecoder final : public TileDecoder {
  public:
    ChunkDecoder(const io::Grid& grid, const io::ChunkSpacing& spacing, const io::ReliefShape& relief)
        : grid_(grid), spacing_(spacing), relief_(relief) {}
    Result<void> decode(const EncodedTile& tile, DecodeScratch& scratch,
                        std::span<std::byte> block) const override;

  private:
    io::Grid grid_;
    io::ChunkSpacing spacing_;
    io::ReliefShape relief_;
};

struct TileSource {
    std::string name;  // for messages: the store's directory
    io::Grid grid;
    io::ChunkSpacing spacing;
    io::ReliefShape relief;
    std::span<const io::NodeRecord> records;
    io::ByteSource* mesh = nullptr;
    io::ByteSource* heights = nullptr;

    io::ChunkShape chunk_shape() const { return {grid.quads(), relief}; }
    const io::NodeRecord& record(NodeIndex node) const { return records[node]; }
    // Bytes of a node's decoded chunk.
    std::size_t chunk_bytes(NodeIndex node) const {
        return io::chunk_layout(records[node], chunk_shape()).total;
    }
};

TileSource tile_source(const io::Store& store);

}  // namespace ridgeline::pager
