// Makes the tiles of nodes: all that lie in one block, or single ones that are larger.
//
// A TileMaker is one thread's working memory; what all share is in TileInputs, immutable meanwhile but for
// the places that a block owns in fine_vertices. Results wait in a TileBatch until the thread that writes
// takes them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ridgeline/base/result.h"
#include "ridgeline/build/block_levels.h"
#include "ridgeline/build/block_window.h"
#include "ridgeline/build/coarse_lattice.h"
#include "ridgeline/build/fine_vertices.h"
#include "ridgeline/build/surface_errors.h"
#include "ridgeline/build/vertex_errors.h"
#include "ridgeline/io/chunk_codec.h"
#include "ridgeline/io/heights_tile.h"
#include "ridgeline/io/relief_maker.h"

namespace ridgeline::build {

struct TileInputs {
    const io::Grid& grid;
    const BlockGrid& blocks;
    const VertexMetric& metric;
    const CoarseLattice& lattice;
    const Levels& levels;
    const CornerSurfaces& corners;
    const VoidFill* fill;                       // null where no sample is invalid
    const std::vector<std::uint8_t>& has_data;  // by linear place of the node
    FineVertices& fine_vertices;
    const io::ReliefShape& relief;
};

struct TileBatch {
    struct Entry {
        io::NodeId node;
        bool has_mask = false;
        io::EncodedChunk chunk;
        std::size_t heights_bytes = 0;
        std::size_t mesh_bytes = 0;
    };
    // Own error, without children's; also of nodes larger than the block, as far as they lie in it.
    struct NodeError {
        io::NodeId node;
        float quanta = 0.0f;
    };
    // What the parent of a node, larger than the block, must know of it.
    struct NodeBounds {
        io::NodeId node;
        io::ReliefBounds bounds;
    };
    std::vector<Entry> entries;  // finer nodes first
    std::vector<NodeError> errors;
    std::vector<NodeBounds> bounds;
    std::vector<std::uint8_t> payloads;  // of the entries in turn: heights, then mesh
    std::optional<Error> failure;

    void clear();
};

class TileMaker {
  public:
    void make_block(const TileInputs& inputs, std::int64_t block, std::span<const std::int32_t> packed,
                    TileBatch& batch);
    // A node larger than a block; after all blocks and its children are made. bounds: of its children.
    void make_coarse(const TileInputs& inputs, io::NodeId node, io::ReliefBounds& bounds, TileBatch& batch);

    // Of the same size and more; the other passes over blocks borrow them.
    BlockWindow window;
    VertexErrors errors;

  private:
    template <class Source>
    void encode(const TileInputs& inputs, io::NodeId node, const Source& source, io::ReliefBounds& bounds,
                TileBatch& batch);
    void make_level(const TileInputs& inputs, io::LatticePoint block_origin, int level, TileBatch& batch);
    void find_ranges(const TileInputs& inputs, io::LatticePoint block_origin);
    void find_errors(const TileInputs& inputs, io::LatticePoint block_origin, TileBatch& batch);

    BlockLevels levels_;
    SurfaceErrors surface_;
    io::HeightsTile tile_;
    io::ChunkScratch chunk_scratch_;
    io::ReliefMaker relief_maker_;
    // Over all samples of a finest node, by node of the block.
    std::vector<SurfaceErrors::Bounds> ranges_;
    // Of the children of the level in work and of those of the next, by node of the block.
    std::vector<io::ReliefBounds> bounds_, parent_bounds_;
    std::vector<float> node_errors_;
};

}  // namespace ridgeline::build
