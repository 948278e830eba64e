// What the pager reads from: the records and the layers' byte sources, and how payloads become a chunk or a
// tile of imagery.
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
#include "ridgeline/io/imagery_record.h"
#include "ridgeline/io/imagery_tile.h"
#include "ridgeline/io/node_record.h"
#include "ridgeline/pager/tile_space.h"

namespace ridgeline::io {
class Store;
}

namespace ridgeline::pager {

// Working memory of one decode at a time; reused, so that decoding does not allocate in steady state.
struct DecodeScratch {
    io::HeightsTile heights;
    io::ChunkScratch chunk;
    io::ImageryScratch imagery;
};

// Two payloads that passed their checksums, to be decoded into `block`.
struct EncodedTile {
    io::NodeId node;
    const io::NodeRecord* record = nullptr;
    std::span<const std::uint8_t> mesh;
    std::span<const std::uint8_t> heights;
};

struct EncodedImagery {
    io::NodeId node;
    std::span<const std::uint8_t> payload;
};

// Any thread, several at once.
class TileDecoder {
  public:
    virtual ~TileDecoder() = default;
    // Writes the chunk into its block, of at least chunk_layout(record).total bytes.
    virtual Result<void> decode(const EncodedTile& tile, DecodeScratch& scratch,
                                std::span<std::byte> block) const = 0;
    // Writes io::kImageryTileBytes into a block of at least as many: io::decode_imagery.
    virtual Result<void> decode_imagery(const EncodedImagery& tile, DecodeScratch& scratch,
                                        std::span<std::byte> block) const;
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

// A tile's bytes on disk: a chunk's mesh and heights; imagery has one payload, and an empty second.
struct TilePayloads {
    io::PayloadRef first;
    io::PayloadRef second;
};

struct ImagerySource {
    io::Grid grid;
    std::span<const io::ImageryRecord> records;
    io::ByteSource* tiles = nullptr;
};

struct TileSource {
    std::string name;  // for messages: the store's directory
    io::Grid grid;
    io::ChunkSpacing spacing;
    io::ReliefShape relief;
    std::span<const io::NodeRecord> records;
    io::ByteSource* mesh = nullptr;
    io::ByteSource* heights = nullptr;
    ImagerySource imagery{};  // empty where the store has none

    TileSpace tiles() const { return {grid, imagery.grid}; }
    io::ChunkShape chunk_shape() const { return {grid.quads(), relief}; }
    const io::NodeRecord& record(NodeIndex node) const { return records[node]; }
    // Bytes of a node's decoded chunk.
    std::size_t chunk_bytes(NodeIndex node) const {
        return io::chunk_layout(records[node], chunk_shape()).total;
    }

    // Of tiles of either kind.
    TileKind kind(NodeIndex tile) const {
        return tile < records.size() ? TileKind::chunk : TileKind::imagery;
    }
    bool has_data(NodeIndex tile) const {
        return kind(tile) == TileKind::chunk ? records[tile].has_data() : imagery_record(tile).has_data();
    }
    TilePayloads payloads(NodeIndex tile) const {
        if (kind(tile) == TileKind::chunk) return {records[tile].mesh, records[tile].heights};
        return {imagery_record(tile).payload(), {}};
    }
    // In RAM.
    std::size_t decoded_bytes(NodeIndex tile) const {
        return kind(tile) == TileKind::chunk ? chunk_bytes(tile) : io::kImageryTileBytes;
    }

  private:
    const io::ImageryRecord& imagery_record(NodeIndex tile) const {
        return imagery.records[tile - records.size()];
    }
};

TileSource tile_source(const io::Store& store);

}  // namespace ridgeline::pager
