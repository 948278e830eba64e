// A chunk: one node's simplified mesh as the GPU draws it, and the memory in which it lies.
//
// A chunk consists of four quarters, the areas of its children, whose borders are mesh edges; so a quarter
// can stand in for a child that is not resident. Each quarter has its inside triangles and, per side, the
// triangles at that side: as they are (plain), or split into fans that hold the border vertices of the next
// finer level as well, at the height of this chunk's edge, so that a finer neighbour meets it without
// T-junctions.
//
// A vertex that the parent's mesh lacks morphs vertically to the parent's surface: quanta + w * delta. Which
// w, its class says: w may differ on every half edge, inner half line, edge midpoint and at the centre
// (docs/selection.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "ridgeline/io/node_id.h"
#include "ridgeline/io/node_record.h"
#include "ridgeline/io/relief.h"

namespace ridgeline::io {

// Half 0 is the western or northern half of a side or line.
namespace vertex_class {
constexpr int kInterior = 0;  // also corners, which never move
constexpr int outer(Side side, int half) { return 1 + 2 * index(side) + half; }
// The lines between quarters: 0 north half and 1 south half of the north-south line, 2 west and 3 east half
// of the west-east line.
constexpr int inner(int line) { return 9 + line; }
constexpr int midpoint(Side side) { return 13 + index(side); }
constexpr int kCentre = 17;
constexpr int kCount = 18;
}  // namespace vertex_class

// The inner line on which quarter's `side` lies, or -1 where that side is on the node's border.
constexpr int inner_line(int quarter, Side side) {
    const int qx = quarter & 1, qy = quarter >> 1;
    if (side == Side::west) return qx == 1 ? qy : -1;
    if (side == Side::east) return qx == 0 ? qy : -1;
    if (side == Side::north) return qy == 1 ? 2 + qx : -1;
    return qy == 0 ? 2 + qx : -1;
}
// Which half of the node's (or line's) length the quarter's side covers.
constexpr int half_of(int quarter, Side side) {
    return (side == Side::west || side == Side::east) ? quarter >> 1 : quarter & 1;
}

// 16 bytes, uploaded as it stands. Offsets count finest samples from the node's north-western corner.
struct ChunkVertex {
    std::uint32_t x_and_class = 0;  // class << 24 | column offset
    std::uint32_t y = 0;            // row offset
    std::int32_t quanta = 0;        // own height
    std::int32_t delta = 0;         // parent surface's height here, rounded to the quantum, minus own

    std::uint32_t x() const { return x_and_class & 0xffffffu; }
    int morph_class() const { return static_cast<int>(x_and_class >> 24); }
};
static_assert(sizeof(ChunkVertex) == 16);

// 16-bit indices with 0xffff never used.
constexpr std::uint32_t kMaxChunkVertices = 65534;

struct IndexRange {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
};

// In index order: insides of the quarters, plain inner sides, plain outer sides clockwise, fans. So a whole
// node with plain sides is one range, and neighbouring ranges merge.
struct ChunkRanges {
    IndexRange inside[kQuarters];
    IndexRange plain[kQuarters][kSides];
    IndexRange fan[kQuarters][kSides];  // empty at the finest level
};

// Normals: (quads+1)^2 texels, two signed-normalised 16-bit components (east, north).
struct NormalTexel {
    std::int16_t east = 0;
    std::int16_t north = 0;
};

// Where the parts of a decoded chunk lie in its block; every offset a multiple of 16, in bytes.
struct ChunkLayout {
    std::size_t vertices = 0;
    std::size_t indices = 0;
    std::size_t mask = 0;      // quads*quads bits, row-major, 32 to a word, least first; only where has_mask
    std::size_t geometry = 0;  // bytes of vertices, indices and mask together: what the GPU's buffer takes
    std::size_t normals = 0;
    std::size_t ranges = 0;
    std::size_t relief = 0;
    std::size_t total = 0;
};

// What all chunks of a store have in common.
struct ChunkShape {
    int quads = 64;
    ReliefShape relief{};
};
ChunkLayout chunk_layout(const NodeRecord& record, const ChunkShape& shape);

// A decoded chunk in memory that somebody else owns (the RAM ring's block).
class ChunkView {
  public:
    ChunkView() = default;
    ChunkView(std::span<std::byte> block, const NodeRecord& record, const ChunkShape& shape);

    explicit operator bool() const { return !block_.empty(); }
    std::span<ChunkVertex> vertices() const;
    std::span<std::uint16_t> indices() const;
    std::span<std::uint32_t> mask() const;  // empty where every cell is valid
    std::span<NormalTexel> normals() const;
    ChunkRanges& ranges() const;
    ReliefView relief() const;
    std::span<const std::byte> geometry() const { return {block_.data(), layout_.geometry}; }
    const ChunkLayout& layout() const { return layout_; }

  private:
    std::span<std::byte> block_;
    ChunkLayout layout_;
    ReliefShape relief_shape_;
    std::uint32_t vertex_count_ = 0;
    std::uint32_t index_count_ = 0;
    std::uint32_t mask_words_ = 0;
    std::uint32_t normal_count_ = 0;
};

}  // namespace ridgeline::io
