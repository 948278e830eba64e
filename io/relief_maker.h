// Makes a node's relief (relief.h) from the chunk that was just encoded: silhouettes on or under the lower
// envelope of what may be drawn, maxima on or over the upper one and over all below the node.
//
// Children come before their parents: what a parent must know of them is handed up as ReliefBounds. Working
// memory, reused from node to node; one a thread.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "ridgeline/io/chunk_codec.h"
#include "ridgeline/io/envelope.h"
#include "ridgeline/io/relief.h"
#include "ridgeline/io/ridge_search.h"

namespace ridgeline::io {

// Of a node with all below it; to begin with, of nothing.
struct ReliefBounds {
    static constexpr std::int32_t kNothing = std::numeric_limits<std::int32_t>::min();

    std::int32_t min_quanta = std::numeric_limits<std::int32_t>::max();
    std::int32_t max_quanta = kNothing;
    // By cell of the node, row by row; empty, or kNothing where nothing is known yet.
    std::vector<std::int32_t> maxima;

    void widen(std::int32_t quanta) {
        min_quanta = std::min(min_quanta, quanta);
        max_quanta = std::max(max_quanta, quanta);
    }
    void add_child(const ReliefShape& shape, int quarter, const ReliefBounds& child);
};

class ReliefMaker {
  public:
    // Appends the relief to the mesh payload of the chunk that encode_chunk has left in `scratch`. bounds:
    // in, of the node's children and of any other heights that the record must hold; out, of the node.
    // encoded: gets them too.
    void append(const Grid& grid, NodeId node, const ReliefShape& shape, ChunkScratch& scratch,
                const HeightsTile& heights, EncodedChunk& encoded, ReliefBounds& bounds,
                std::vector<std::uint8_t>& payload);

  private:
    void find_maxima(const Bisection& bisection, std::int64_t step, const NodeRecord& record,
                     ReliefBounds& bounds, ReliefView relief);
    void raise_by_vertices(const Bisection& bisection, std::uint32_t step, const ReliefShape& shape);
    void find_silhouettes(const HeightsTile& heights, const NodeRecord& record, ReliefView relief);
    void find_silhouette(ReliefAxis axis, int band, const NodeRecord& record, ReliefView relief);
    void lower(double floor);

    int quads_ = 0;
    Envelope envelope_;
    RidgeSearch ridges_;
    std::vector<double> row_, greatest_;  // greatest: of the upper envelope, by cell
    std::vector<LatticeRange> cells_of_quad_;
    std::vector<float> lattice_;
    // Of the chain in work: the envelope along each segment, empty where there is no ground; and its heights,
    // infinite where it has none.
    std::vector<std::vector<Envelope::Point>> limits_;
    std::vector<double> chain_;
    std::vector<std::byte> bytes_;
};

}  // namespace ridgeline::io
