#include "ridgeline/io/chunk_reader.h"

#include <span>

namespace ridgeline::io {

Result<void> ChunkReader::read(NodeId node, OwnedChunk& chunk) {
    const NodeRecord& record = store_.record(node);
    chunk.view = {};
    RIDGELINE_TRY(store_.read_heights(node, bytes_, heights_));
    RIDGELINE_TRY(store_.read_payload(Layer::mesh, node, bytes_));
    const ChunkShape shape = store_.chunk_shape();
    chunk.block.resize(chunk_layout(record, shape).total / sizeof(ChunkVertex) + 1);
    chunk.view = ChunkView(std::as_writable_bytes(std::span(chunk.block)), record, shape);
    return decode_chunk(store_.grid(), node, record, store_.chunk_spacing(), bytes_, heights_, scratch_,
                        chunk.view);
}

}  // namespace ridgeline::io
