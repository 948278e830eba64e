#include "ridgeline/pager/tile_source.h"

#include "ridgeline/io/store.h"

namespace ridgeline::pager {

Result<void> ChunkDecoder::decode(const EncodedTile& tile, DecodeScratch& scratch,
                                  std::span<std::byte> block) const {
    RIDGELINE_TRY(io::decode_heights(tile.heights, grid_.quads(), scratch.heights));
    return io::decode_chunk(grid_, tile.node, *tile.record, spacing_, tile.mesh, scratch.heights,
                            scratch.chunk, io::ChunkView(block, *tile.record, {grid_.quads(), relief_}));
}

Result<void> TileDecoder::decode_imagery(const EncodedImagery& tile, DecodeScratch& scratch,
                                         std::span<std::byte> block) const {
    return io::decode_imagery(tile.payload, scratch.imagery, block.first(io::kImageryTileBytes));
}

Result<void> TileDecoder::decode_heights(const EncodedHeights& tile, DecodeScratch& scratch,
                                         std::span<std::byte> block) const {
    RIDGELINE_TRY(io::decode_heights(tile.payload, tile.quads, scratch.heights));
    pack_heights(scratch.heights, tile.filter, block.first(heights_texels_bytes(tile.quads)));
    return {};
}

TileSource tile_source(const io::Store& store, HeightsTiles heights) {
    TileSource source;
    source.heights_tiles = heights;
    source.name = store.directory().string();
    source.grid = store.grid();
    source.records = store.records();
    source.spacing = store.chunk_spacing();
    source.relief = store.info().relief;
    source.mesh = &store.layer(io::Layer::mesh);
    source.heights = &store.layer(io::Layer::heights);
    if (store.info().imagery)
        source.imagery = {store.imagery_grid(), store.imagery_records(), &store.layer(io::Layer::imagery)};
    return source;
}

}  // namespace ridgeline::pager
