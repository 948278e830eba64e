// What the pager reads from: the records and the layers' byte sources, and how payloads become a chunk, a
// tile of imagery or one of heights.
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
#include "ridgeline/pager/heights_texels.h"
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

struct EncodedHeights {
    io::NodeId node;
    int quads = 64;
    HeightsFilter filter = HeightsFilter::none;
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
    // Writes heights_texels_bytes(quads) into a block of at least as many: pack_heights.
    virtual Result<void> decode_heights(const EncodedHeights& tile, DecodeScratch& scratch,
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

// A tile's bytes on disk: a chunk's mesh and heights; the others have one payload, and an empty second.
struct TilePayloads {
    io::PayloadRef first;
    io::PayloadRef second;
};

struct ImagerySource {
    io::Grid grid;
    std::span<const io::ImageryRecord> records;
    io::ByteSource* tiles = nullptr;
};

enum class HeightsTiles { none, paged };

struct TileSource {
    std::string name;  // for messages: the store's directory
    io::Grid grid;
    io::ChunkSpacing spacing;
    io::ReliefShape relief;
    std::span<const io::NodeRecord> records;
    io::ByteSource* mesh = nullptr;
    io::ByteSource* heights = nullptr;
    ImagerySource imagery{};  // empty where the store has none
    // Whether heights are paged as tiles of their own, for surfaces that sample them.
    HeightsTiles heights_tiles = HeightsTiles::none;

    HeightsFilter heights_filter(io::NodeId node) const {
        return node.level == grid.finest() ? HeightsFilter::none : HeightsFilter::twice_spacing;
    }
    io::Grid heights_grid() const { return heights_tiles == HeightsTiles::paged ? grid : io::Grid(); }
    TileSpace tiles() const { return {grid, imagery.grid, heights_grid()}; }
    io::ChunkShape chunk_shape() const { return {grid.quads(), relief}; }
    const io::NodeRecord& record(NodeIndex node) const { return records[node]; }
    // Bytes of a node's decoded chunk.
    std::size_t chunk_bytes(NodeIndex node) const {
        return io::chunk_layout(records[node], chunk_shape()).total;
    }

    // Of tiles of any kind.
    TileKind kind(NodeIndex tile) const {
        if (tile < records.size()) return TileKind::chunk;
        return tile - records.size() < imagery.records.size() ? TileKind::imagery : TileKind::heights;
    }
    bool has_data(NodeIndex tile) const {
        return kind(tile) == TileKind::imagery ? imagery_record(tile).has_data()
                                               : records[terrain_node(tile)].has_data();
    }
    TilePayloads payloads(NodeIndex tile) const {
        if (kind(tile) == TileKind::chunk) return {records[tile].mesh, records[tile].heights};
        if (kind(tile) == TileKind::heights) return {records[terrain_node(tile)].heights, {}};
        return {imagery_record(tile).payload(), {}};
    }
    // In RAM.
    std::size_t decoded_bytes(NodeIndex tile) const {
        if (kind(tile) == TileKind::chunk) return chunk_bytes(tile);
        return kind(tile) == TileKind::imagery ? io::kImageryTileBytes : heights_texels_bytes(grid.quads());
    }

  private:
    // Of a chunk or a tile of heights.
    std::size_t terrain_node(NodeIndex tile) const {
        return tile < records.size() ? tile : tile - records.size() - imagery.records.size();
    }
    const io::ImageryRecord& imagery_record(NodeIndex tile) const {
        return imagery.records[tile - records.size()];
    }
};

TileSource tile_source(const io::Store& store, HeightsTiles heights = HeightsTiles::none);

}  // namespace ridgeline::pager
