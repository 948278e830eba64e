// The mesh payload: a chunk as bits in bisection order, and back.
//
// Topology is implicit in the order of the right-triangle bisection (bisection.h): one split bit a triangle
// pair, one bit whether the parent's mesh holds the vertex, one height residual; fans as bits of a bisection
// along each side; the node's relief behind it (relief_codec.h). Everything else (indices, morph deltas,
// classes, ranges, normals) is rebuilt at decode.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "ridgeline/base/result.h"
#include "ridgeline/io/chunk.h"
#include "ridgeline/io/grid.h"
#include "ridgeline/io/heights_tile.h"

namespace ridgeline::io {

// What the encoder asks about the samples of a node; x, y count finest samples from the node's corner and lie
// within [0, extent]. A vertex set holds with a vertex all its ancestors.
class ChunkSource {
  public:
    virtual ~ChunkSource() = default;
    virtual std::int32_t quanta(std::int64_t x, std::int64_t y) const = 0;
    // In the vertex set of the level `relative` above the node's own: -1 the finer, 0 own, 1 the parent's.
    virtual bool in_level(std::int64_t x, std::int64_t y, int relative) const = 0;
};

// The same for heights and levels in arrays, which encodes faster; both point to the node's north-western
// corner.
struct DenseChunkSource {
    const std::int32_t* heights = nullptr;
    std::ptrdiff_t heights_stride = 0;
    // Of each lattice point the coarsest level whose vertex set holds it, or more than any level.
    const std::uint8_t* levels = nullptr;
    std::ptrdiff_t levels_stride = 0;
    int level = 0;  // the node's own

    std::int32_t quanta(std::int64_t x, std::int64_t y) const { return heights[y * heights_stride + x]; }
    bool in_level(std::int64_t x, std::int64_t y, int relative) const {
        return levels[y * levels_stride + x] <= level - relative;
    }
};

struct EncodedChunk {
    std::uint32_t vertex_count = 0;
    std::uint32_t index_count = 0;
    std::uint32_t triangle_count = 0;
    // Over own heights and the parent surface's heights at the vertices.
    std::int32_t min_quanta = 0;
    std::int32_t max_quanta = 0;
};

// Working memory of encoder and decoder, reused from chunk to chunk; one a thread.
class ChunkScratch {
  public:
    ChunkScratch();
    ~ChunkScratch();
    ChunkScratch(ChunkScratch&&) noexcept;
    ChunkScratch& operator=(ChunkScratch&&) noexcept;
    struct State;
    State& state() { return *state_; }

  private:
    std::unique_ptr<State> state_;
};

// Appends the node's mesh payload but for the relief (relief_maker.h), which is made from what is left in
// `scratch`. Fails where the chunk would need more than kMaxChunkVertices.
Result<EncodedChunk> encode_chunk(const Grid& grid, NodeId node, const ChunkSource& source,
                                  ChunkScratch& scratch, std::vector<std::uint8_t>& payload);
Result<EncodedChunk> encode_chunk(const Grid& grid, NodeId node, const DenseChunkSource& source,
                                  ChunkScratch& scratch, std::vector<std::uint8_t>& payload);

// Rebuilds the chunk in its block: vertices, indices, ranges and relief from the mesh payload; mask and
// normals from the heights tile. Any damage is an Error, never a read or
// write out of bounds. Normals are those of the terrain without exaggeration.
struct ChunkSpacing {
    double x_m = 1.0, y_m = 1.0;  // of the finest samples
    double quantum_m = 1.0;
};
Result<void> decode_chunk(const Grid& grid, NodeId node, const NodeRecord& record,
                          const ChunkSpacing& spacing, std::span<const std::uint8_t> mesh_payload,
                          const HeightsTile& heights, ChunkScratch& scratch, ChunkView chunk);

}  // namespace ridgeline::io
